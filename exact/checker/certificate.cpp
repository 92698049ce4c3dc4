#include "exact/checker/certificate.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace touchstone::checker {
namespace {

// ---- Numbers ------------------------------------------------------------------------------------

mpz_class parse_digits(std::string_view digits, int base) {
  const auto known = std::string_view("0123456789abcdef").substr(0, std::size_t(base));
  if (digits.empty() || digits.find_first_not_of(known) != std::string_view::npos) {
    reject("not a number");
  }
  // 2^16384 has 4933 decimal digits; a longer text is not worth its conversion.
  require_at_most(base == 10 ? 4'933 : max_number_bits / 4, digits.size(), "digits in a number");
  mpz_class number(std::string(digits), base);
  require_at_most(max_number_bits, mpz_sizeinbase(number.get_mpz_t(), 2), "bits in a number");
  return number;
}

/// A decimal integer without a sign, in its only form.
mpz_class parse_decimal(std::string_view digits) {
  mpz_class number = parse_digits(digits, 10);
  if (digits.size() > 1 && digits.front() == '0') reject("an integer with leading zeros");
  return number;
}

/// The parts before and after the separator; without one, the whole text and `behind`.
std::array<std::string_view, 2> parted(std::string_view text, char separator,
                                       std::string_view behind) {
  const std::size_t place = text.find(separator);
  if (place == std::string_view::npos) return {text, behind};
  return {text.substr(0, place), text.substr(place + 1)};
}

/// Parses [±]D, decimal digits.
long parse_power_of_two(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  const bool is_signed = is_negative || text.starts_with('+');
  const std::string_view digits = text.substr(is_signed ? 1 : 0);
  require_at_most(6, digits.size(), "digits in a power of two");
  const long power = parse_digits(digits, 10).get_si();
  return is_negative ? -power : power;
}

/// Parses the text after 0x: H[.H]p[±]D, H hexadecimal and D decimal digits.
mpq_class parse_hexadecimal(std::string_view text) {
  const auto [digits, power] = parted(text, 'p', "");
  const auto [whole, fraction] = parted(digits, '.', "");
  if (whole.empty() || digits.ends_with('.')) reject("not a number");
  const long exponent = parse_power_of_two(power) - 4 * static_cast<long>(fraction.size());
  mpq_class number(parse_digits(std::string(whole).append(fraction), 16));
  // The integers of the fraction: number · 2^exponent / 1 or number / 2^−exponent.
  constexpr long limit = max_number_bits;
  const long margin = limit - static_cast<long>(mpz_sizeinbase(number.get_num_mpz_t(), 2));
  if (exponent > margin || 1 - exponent > limit) reject("too large or small a power of two");
  if (exponent > 0) {
    number <<= static_cast<mp_bitcnt_t>(exponent);
  } else {
    number >>= static_cast<mp_bitcnt_t>(-exponent);
  }
  return number;
}

mpq_class parse_fraction(std::string_view text) {
  const auto [above, below] = parted(text, '/', "1");
  mpq_class number(parse_decimal(above), parse_decimal(below));
  if (number.get_den() == 0) reject("a denominator that is 0");
  number.canonicalize();
  return number;
}

/// The number that parse() makes of the word without its sign.
template <class Parse>
auto signed_number(std::string_view word, const Parse& parse) try {
  const bool is_negative = word.starts_with('-');
  auto number = parse(word.substr(is_negative ? 1 : 0));
  // C's %a writes one zero with a sign; no integer is written so.
  if (is_negative && number == 0 && !word.starts_with("-0x")) reject("a zero with a sign");
  if (is_negative) number = -number;
  return number;
} catch (const Rejection& rejection) {
  reject(rejection.reason + ": " + quoted(word));
}

// ---- The parts of a certificate -----------------------------------------------------------------

void read_claim(Reader& reader, Certificate& certificate) {
  certificate.line = reader.begin("claim");
  // The words are in the order of the enumeration, here and below.
  certificate.claim =
      static_cast<Claim>(certificate.query.kind == Kind::tetrahedron
                             ? reader.one_of({"no_inversion", "inversion", "time_of_inversion"})
                             : reader.one_of({"no_collision", "collision", "time_of_impact"}));
  if (certificate.claim == Claim::no_collision) certificate.lower = 1;
  if (certificate.claim == Claim::time_of_impact) {
    take_time_of_impact(reader, certificate.lower, certificate.upper);
  }
  reader.end();
}

Point take_point(Reader& reader) {
  Point point;
  for (mpq_class& coordinate : point) coordinate = take_number(reader);
  return point;
}

/// Reads the points of straight lines: all at t=0, then all at t=1.
void read_lines(Reader& reader, Query& query) {
  for (std::size_t end = 0; end < 2; ++end) {
    for (Curve& curve : query.points) {
      reader.begin("point");
      curve.control.push_back(take_point(reader));
      reader.end();
    }
  }
}

/// Reads `curve K` or `rational K`, and its control points.
Curve read_curve(Reader& reader) {
  Curve curve;
  reader.begin();
  const bool is_rational = reader.one_of({"curve", "rational"}) == 1;
  const mpz_class degree = signed_number(reader.word(), parse_decimal);
  if (degree < 0 || degree > static_cast<unsigned long>(max_curve_degree))
    reject("a degree that is not 0 to " + std::to_string(max_curve_degree));
  reader.end();
  for (unsigned long j = 0; j <= degree.get_ui(); ++j) {
    reader.begin("point");
    curve.control.push_back(take_point(reader));
    if (is_rational) curve.weights.push_back(take_number(reader));
    if (is_rational && curve.weights.back() <= 0) reject("a weight that is not positive");
    reader.end();
  }
  return curve;
}

std::size_t take_axis(Reader& reader) { return reader.one_of({"x", "y", "z"}); }

void take_corners(Reader& reader, const Query& query, std::size_t count, Part& part) {
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t corner = reader.one_of({"0", "1", "2", "3"});
    if (corner == 3 && query.kind != Kind::edge_edge) reject("a vertex_face has no corner 3");
    part.corners.at(n) = corner;
  }
}

void take_feature(Reader& reader, const Query& query, Subinterval& subinterval) {
  using enum Feature;
  if (query.kind == Kind::tetrahedron) {
    reader.one_of({"face"});
    reader.one_of({"-"});
    return;
  }
  const Feature feature =
      static_cast<Feature>(reader.one_of({"vertex", "edge", "face", "axis", "cross"}));
  subinterval.feature = feature;
  if (feature == axis || feature == cross) subinterval.axis = take_axis(reader);
  if (feature == vertex) take_corners(reader, query, 1, subinterval);
  if (feature == edge || feature == cross) take_corners(reader, query, 2, subinterval);
  if (feature == face || feature == axis) subinterval.is_negative = reader.one_of({"+", "-"}) == 1;
}

/// Takes `time T` or `root LO HI G0 … Gn`.
void take_time(Reader& reader, Contact& contact) {
  contact.is_root = reader.one_of({"time", "root"}) == 1;
  contact.from = take_number(reader);
  contact.to = contact.from;
  if (!contact.is_root) return;
  contact.to = take_number(reader);
  while (reader.has_word()) {
    contact.g.push_back(signed_number(reader.word(), parse_decimal));
    require_at_most(max_root_degree + 1, contact.g.size(), "coefficients in a polynomial");
  }
  if (contact.g.size() < 2) reject("a polynomial of a degree below 1");
  if (contact.g.back() == 0) reject("a polynomial whose leading coefficient is 0");
}

void take_place(Reader& reader, const Query& query, Contact& contact) {
  using enum Place;
  if (query.kind == Kind::tetrahedron) {
    reader.one_of({"plane"});
    return;
  }
  const Place place =
      static_cast<Place>(reader.one_of({"vertex", "segment", "triangle", "edge", "face", "axes"}));
  contact.place = place;
  if (place == vertex) take_corners(reader, query, 1, contact);
  if (place == segment || place == edge) take_corners(reader, query, 2, contact);
  if (place == triangle) take_corners(reader, query, 3, contact);
  if (place == triangle) contact.axis = take_axis(reader);
}

}  // namespace

void require_at_most(std::size_t limit, std::size_t count, std::string_view what) {
  if (count > limit) reject("more than " + std::to_string(limit) + ' ' + std::string(what));
}

std::string printable(std::string_view text) {
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    if (c >= ' ' && c <= '~') {
      result += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    result += "\\x";
    result += digits[byte / 16U];
    result += digits[byte % 16U];
  }
  return result;
}

std::string quoted(std::string_view word) {
  return "'" + printable(word.substr(0, 40)) + (word.size() > 40 ? "...'" : "'");
}

mpq_class parse_number(std::string_view word) {
  return signed_number(word, [](std::string_view text) {
    return text.starts_with("0x") ? parse_hexadecimal(text.substr(2)) : parse_fraction(text);
  });
}

std::string to_text(const mpq_class& number) {
  std::string fraction = number.get_str();
  const bool is_dyadic = mpz_popcount(number.get_den_mpz_t()) == 1;
  if (number == 0 || !is_dyadic) return fraction;
  // ± 1.H · 2^power; `digits` are those of 1H.
  mpz_class digits = abs(number.get_num());
  const mp_bitcnt_t zeros = mpz_scan1(digits.get_mpz_t(), 0);
  digits >>= zeros;
  const std::size_t bits_behind_point = mpz_sizeinbase(digits.get_mpz_t(), 2) - 1;
  const auto denominator_bits = static_cast<long>(mpz_scan1(number.get_den_mpz_t(), 0));
  const long power = static_cast<long>(zeros + bits_behind_point) - denominator_bits;
  digits <<= (4 - bits_behind_point % 4) % 4;
  std::string text = digits.get_str(16);
  if (text.size() > 1) text.insert(1, ".");
  text = (number < 0 ? "-0x" : "0x") + text + (power < 0 ? "p" : "p+") + std::to_string(power);
  return text.size() < fraction.size() ? text : fraction;
}

std::string to_text(const Certificate& certificate) {
  const bool is_tetrahedron = certificate.query.kind == Kind::tetrahedron;
  if (certificate.claim == Claim::no_collision) {
    return is_tetrahedron ? "no_inversion" : "no_collision";
  }
  if (certificate.claim == Claim::collision) return is_tetrahedron ? "inversion" : "collision";
  return (is_tetrahedron ? "time_of_inversion " : "time_of_impact ") + to_text(certificate.lower) +
         ' ' + to_text(certificate.upper);
}

std::string to_text(const Separation& separation, bool is_norm_named) {
  std::string distance = to_text(separation.distance);
  if (separation.distance == 0 && !is_norm_named) return distance;
  return distance + (separation.is_l2 ? " l2" : " linf");
}

// ---- Lines and words ----------------------------------------------------------------------------

void Reader::read_line() {
  stream_->getline(buffer_.data() + 1, std::ssize(buffer_) - 1);
  auto length = static_cast<std::size_t>(stream_->gcount());
  bytes_ += static_cast<std::int64_t>(length);
  at_end_ = stream_->eof() && length == 0;
  fault_ = nullptr;
  if (at_end_) {
    fault_ = "the stream ends within a certificate";
  } else if (stream_->eof()) {
    fault_ = "the last line is not ended by a newline";
  } else if (stream_->fail()) {
    fault_ = "the line is too long";
    stream_->clear(stream_->rdstate() & ~std::ios::failbit);
    stream_->ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  } else {
    --length;  // getline counts the newline but does not store it
  }
  if (stream_->bad()) throw std::runtime_error("the stream cannot be read");
  if (!at_end_) ++number_;
  text_ = {buffer_.data() + 1, length};
}

void Reader::advance() {
  bool is_skipped = true;
  while (is_skipped) {
    read_line();
    const bool is_comment = text_.empty() || text_.front() == '#';
    is_skipped = is_comment && fault_ == nullptr && number_ > 1;
  }
}

std::size_t Reader::begin(std::string_view keyword) {
  if (fault_ != nullptr) reject(fault_);
  rest_ = {buffer_.data(), text_.size() + 1};
  if (!keyword.empty() && word() != keyword) {
    reject("expected '" + std::string(keyword) + "', found " + quoted(first_word()));
  }
  return number_;
}

std::string_view Reader::word() {
  if (rest_.empty()) reject("the line has too few words");
  rest_.remove_prefix(1);
  const std::string_view word = rest_.substr(0, rest_.find(' '));
  rest_.remove_prefix(word.size());
  return word;
}

std::size_t Reader::one_of(std::initializer_list<std::string_view> words) {
  const std::string_view found = word();
  const auto* const place = std::find(words.begin(), words.end(), found);
  if (place == words.end()) reject("unknown word: " + quoted(found));
  return static_cast<std::size_t>(place - words.begin());
}

void Reader::end() {
  if (!rest_.empty()) reject("the line has too many words");
  advance();
}

// ---- Certificates -------------------------------------------------------------------------------

mpq_class take_number(Reader& reader) { return parse_number(reader.word()); }

std::string read_label(Reader& reader, std::string_view keyword) {
  reader.begin(keyword);
  const std::string_view line = reader.text();
  const std::size_t place = keyword.size() + 1;
  std::string label(line.substr(std::min(place, line.size())));
  require_at_most(max_label_bytes, label.size(), "bytes in a label");
  reader.advance();
  return label;
}

Separation read_separation(Reader& reader) {
  Separation separation;
  reader.begin("separation");
  separation.distance = take_number(reader);
  if (separation.distance < 0) reject("a distance below 0");
  separation.is_l2 = reader.one_of({"linf", "l2"}) == 1;
  reader.end();
  return separation;
}

void take_time_of_impact(Reader& reader, mpq_class& lower, mpq_class& upper) {
  lower = take_number(reader);
  upper = take_number(reader);
  const bool is_at_start = lower == 0 && upper == 0;
  const bool is_interval = 0 <= lower && lower < upper && upper <= 1;
  if (!is_at_start && !is_interval) {
    reject("a time of impact is 0 0, or LO HI with 0 <= LO < HI <= 1");
  }
}

std::vector<Subinterval> read_subintervals(Reader& reader, const Query& query) {
  std::vector<Subinterval> subintervals;
  while (reader.first_word() == "separate") {
    Subinterval& subinterval = subintervals.emplace_back();
    require_at_most(max_subintervals, subintervals.size(), "subintervals");
    subinterval.line = reader.begin("separate");
    subinterval.from = take_number(reader);
    subinterval.to = take_number(reader);
    take_feature(reader, query, subinterval);
    reader.end();
  }
  return subintervals;
}

Contact read_contact(Reader& reader, const Query& query) {
  Contact contact;
  contact.line = reader.begin("contact");
  take_time(reader, contact);
  reader.end();
  reader.begin("at");
  take_place(reader, query, contact);
  reader.end();
  return contact;
}

void read_certificate(Reader& reader, Certificate& certificate) {
  Query& query = certificate.query;
  reader.begin("query");
  query.kind = static_cast<Kind>(reader.one_of({"vertex_face", "edge_edge", "tetrahedron"}));
  reader.end();
  if (reader.first_word() == "label") certificate.label = read_label(reader, "label");
  if (reader.first_word() == "curve" || reader.first_word() == "rational") {
    for (Curve& curve : query.points) curve = read_curve(reader);
  } else {
    read_lines(reader, query);
  }
  if (reader.first_word() == "separation" && query.kind != Kind::tetrahedron) {
    certificate.separation = read_separation(reader);
  }
  read_claim(reader, certificate);
  if (certificate.has_subintervals()) certificate.subintervals = read_subintervals(reader, query);
  if (certificate.has_contact()) certificate.contact = read_contact(reader, query);
  reader.begin("end");
  reader.end();
}

}  // namespace touchstone::checker

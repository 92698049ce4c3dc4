#include "exact/checker/certificate.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace touchstone::checker {
namespace {

// ---- Numbers --------------------------------------------------------------------------------------

mpz_class parse_digits(std::string_view digits, int base) {
  const auto known = std::string_view("0123456789abcdef").substr(0, std::size_t(base));
  if (digits.empty() || digits.find_first_not_of(known) != std::string_view::npos)
    reject("not a number");
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

/// The parts of a text before and behind a separator, which may be missing.
std::array<std::string_view, 2> parted(std::string_view text, char separator,
                                       std::string_view behind) {
  const std::size_t place = text.find(separator);
  if (place == std::string_view::npos) return {text, behind};
  return {text.substr(0, place), text.substr(place + 1)};
}

/// The text after 0x: H[.H]p[±]D, H hexadecimal and D decimal digits.
mpq_class parse_hexadecimal(std::string_view text) {
  const auto [digits, signed_power] = parted(text, 'p', "");
  const auto [whole, fraction] = parted(digits, '.', "");
  std::string_view power = signed_power;
  const bool is_signed = power.starts_with('-') || power.starts_with('+');
  power.remove_prefix(is_signed ? 1 : 0);
  if (whole.empty() || digits.ends_with('.')) reject("not a number");
  require_at_most(6, power.size(), "digits in a power of two");
  long exponent = long(parse_digits(power, 10).get_si());
  if (signed_power.starts_with('-')) exponent = -exponent;
  exponent -= 4 * std::ssize(fraction);
  mpq_class number(parse_digits(std::string(whole).append(fraction), 16));
  // The integers of the fraction: number · 2^exponent / 1 or number / 2^−exponent.
  constexpr long limit = max_number_bits;
  const long margin = limit - static_cast<long>(mpz_sizeinbase(number.get_num_mpz_t(), 2));
  if (exponent > margin || 1 - exponent > limit) reject("too large or small a power of two");
  exponent > 0 ? number <<= mp_bitcnt_t(exponent) : number >>= mp_bitcnt_t(-exponent);
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

void read_query(Reader& reader, Certificate& certificate) {
  reader.begin("query");
  certificate.is_edge_edge = reader.one_of({"vertex_face", "edge_edge"}) == 1;
  reader.end();
  if (reader.first_word() == "label") {
    reader.begin();
    const std::string_view text = reader.text();
    certificate.label = text.substr(std::min<std::size_t>(6, text.size()));
    require_at_most(max_label_bytes, certificate.label.size(), "bytes in a label");
    reader.advance();
  }
  for (std::size_t n = 0; n < certificate.coordinates.size(); ++n) {
    if (n % 3 == 0) reader.begin("point");
    certificate.coordinates[n] = read_number(reader);
    if (n % 3 == 2) reader.end();
  }
  if (reader.first_word() == "separation") read_separation(reader, certificate);
}

void read_claim(Reader& reader, Certificate& certificate) {
  certificate.line = reader.begin("claim");
  certificate.claim = Claim(reader.one_of({"no_collision", "collision", "time_of_impact"}));
  if (certificate.claim == Claim::no_collision) certificate.lower = 1;
  if (certificate.claim == Claim::time_of_impact) read_time_of_impact(reader, certificate);
  reader.end();
}

void read_corners(Reader& reader, const Certificate& certificate, std::size_t count, Part& part) {
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t corner = part.corners.at(n) = reader.one_of({"0", "1", "2", "3"});
    if (corner == 3 && !certificate.is_edge_edge) reject("a vertex_face has no corner 3");
  }
}

}  // namespace

void require_at_most(std::size_t limit, std::size_t count, std::string_view what) {
  if (count > limit) reject("more than " + std::to_string(limit) + ' ' + std::string(what));
}

std::string printable(std::string_view text) {
  static constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const std::array escaped{'\\', 'x', digits[byte / 16U], digits[byte % 16U]};
    c >= ' ' && c <= '~' ? result += c : result.append(escaped.begin(), escaped.end());
  }
  return result;
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
  static constexpr std::array names{"no_collision", "collision", "time_of_impact"};
  std::string name = names.at(std::size_t(certificate.claim));
  if (certificate.claim != Claim::time_of_impact) return name;
  return name + ' ' + to_text(certificate.lower) + ' ' + to_text(certificate.upper);
}

std::string separation_text(const Certificate& certificate) {
  const std::string distance = to_text(certificate.distance);
  return certificate.distance == 0 ? distance : distance + (certificate.is_l2 ? " l2" : " linf");
}

std::string quoted(std::string_view word) {
  return "'" + printable(word.substr(0, 40)) + (word.size() > 40 ? "...'" : "'");
}

void Reader::advance() {
  do {
    stream_->getline(buffer_.data() + 1, std::ssize(buffer_) - 1);
    auto length = static_cast<std::size_t>(stream_->gcount());
    bytes_ += std::int64_t(length);
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
  } while (number_ > 1 && fault_ == nullptr && (text_.empty() || text_.front() == '#'));
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

mpq_class read_number(Reader& reader) { return parse_number(reader.word()); }

void read_separation(Reader& reader, Certificate& certificate) {
  reader.begin("separation");
  certificate.distance = read_number(reader);
  if (certificate.distance < 0) reject("a distance below 0");
  certificate.is_l2 = reader.one_of({"linf", "l2"}) == 1;
  reader.end();
}

void read_time_of_impact(Reader& reader, Certificate& certificate) {
  const mpq_class& lower = certificate.lower = read_number(reader);
  const mpq_class& upper = certificate.upper = read_number(reader);
  if ((lower != 0 || upper != 0) && (lower < 0 || lower >= upper || upper > 1)) {
    reject("a time of impact is 0 0, or LO HI with 0 <= LO < HI <= 1");
  }
}

void read_subintervals(Reader& reader, Certificate& certificate) {
  for (certificate.subintervals.clear(); reader.first_word() == "separate"; reader.end()) {
    Subinterval& subinterval = certificate.subintervals.emplace_back();
    require_at_most(max_subintervals, certificate.subintervals.size(), "subintervals");
    subinterval.line = reader.begin("separate");
    subinterval.from = read_number(reader);
    subinterval.to = read_number(reader);
    subinterval.feature = Feature(reader.one_of({"vertex", "edge", "face", "axis", "cross"}));
    if (subinterval.feature >= Feature::axis) subinterval.axis = reader.one_of({"x", "y", "z"});
    static constexpr std::array<std::size_t, 5> counts{1, 2, 0, 0, 2};
    const std::size_t count = counts.at(std::size_t(subinterval.feature));
    read_corners(reader, certificate, count, subinterval);
    if (count == 0) subinterval.is_negative = reader.one_of({"+", "-"}) == 1;
  }
}

void read_contact(Reader& reader, Certificate& certificate) {
  Contact& contact = certificate.contact;
  contact.line = reader.begin("contact");
  contact.is_root = reader.one_of({"time", "root"}) == 1;
  contact.from = read_number(reader);
  contact.to = contact.is_root ? read_number(reader) : contact.from;
  while (contact.is_root && reader.has_word()) {
    contact.g.push_back(signed_number(reader.word(), parse_decimal));
    require_at_most(max_root_degree + 1, contact.g.size(), "coefficients in a polynomial");
  }
  if (contact.is_root && contact.g.size() < 2) reject("a polynomial of a degree below 1");
  if (contact.is_root && contact.g.back() == 0)
    reject("a polynomial whose leading coefficient is 0");
  reader.end();
  reader.begin("at");
  contact.place = Place(reader.one_of({"vertex", "segment", "triangle", "edge", "face", "axes"}));
  static constexpr std::array<std::size_t, 6> counts{1, 2, 3, 2, 0, 0};
  read_corners(reader, certificate, counts.at(std::size_t(contact.place)), contact);
  if (contact.place == Place::triangle) contact.axis = reader.one_of({"x", "y", "z"});
  reader.end();
}

void read_certificate(Reader& reader, Certificate& certificate) {
  read_query(reader, certificate);
  read_claim(reader, certificate);
  if (certificate.has_subintervals()) read_subintervals(reader, certificate);
  if (certificate.claim != Claim::no_collision) read_contact(reader, certificate);
  reader.begin("end");
  reader.end();
}

}  // namespace touchstone::checker

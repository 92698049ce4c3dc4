#include "exact/checker/certificate.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace touchstone::checker {
namespace {

/// The beginning of a word, for a message.
std::string quoted(std::string_view word) {
  return "'" + printable(word.substr(0, 40)) + (word.size() > 40 ? "...'" : "'");
}

// ---- Numbers: what is taken is taken from the beginning of a text ---------------------------------

[[noreturn]] void reject_as_too_large() {
  reject("a number with more than " + std::to_string(max_number_bits) + " bits");
}

bool take(std::string_view& text, std::string_view beginning) {
  if (!text.starts_with(beginning)) return false;
  text.remove_prefix(beginning.size());
  return true;
}

/// Takes at least one digit.
std::string_view take_digits(std::string_view& text, int base) {
  std::size_t count = 0;
  const auto is_digit = [&](char c) {
    return (c >= '0' && c <= '9') || (base == 16 && c >= 'a' && c <= 'f');
  };
  while (count < text.size() && is_digit(text[count])) ++count;
  if (count == 0) reject("not a number");
  const std::string_view digits = text.substr(0, count);
  text.remove_prefix(count);
  return digits;
}

mpz_class from_digits(std::string_view digits, int base) {
  if (digits.size() <= 16) {
    unsigned long small = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), small, base);
    return small;
  }
  // 2^16384 has 4933 decimal digits; a longer text is not worth its conversion.
  if (digits.size() > (base == 10 ? 4'933 : max_number_bits / 4)) reject_as_too_large();
  mpz_class number(std::string(digits), base);
  if (mpz_sizeinbase(number.get_mpz_t(), 2) > max_number_bits) reject_as_too_large();
  return number;
}

/// The text after 0x: H[.H]p[±]D, H hexadecimal and D decimal digits.
void take_hexadecimal(std::string_view& text, mpq_class& number) {
  std::string digits(take_digits(text, 16));
  const std::size_t whole_digits = digits.size();
  if (take(text, ".")) digits += take_digits(text, 16);
  if (!take(text, "p")) reject("not a number");
  const long sign = take(text, "-") ? -1 : 1;
  if (sign > 0) take(text, "+");
  const std::string_view power = take_digits(text, 10);
  if (power.size() > 6) reject_as_too_large();
  long exponent = 0;
  std::from_chars(power.begin(), power.end(), exponent);
  exponent = sign * exponent - 4 * static_cast<long>(digits.size() - whole_digits);
  number.get_num() = from_digits(digits, 16);
  // The integers of the fraction: number · 2^exponent / 1 or number / 2^−exponent.
  constexpr long limit = max_number_bits;
  const long room = limit - static_cast<long>(mpz_sizeinbase(number.get_num_mpz_t(), 2));
  if (exponent > room || 1 - exponent > limit) reject_as_too_large();
  if (exponent > 0) number <<= static_cast<mp_bitcnt_t>(exponent);
  if (exponent < 0) number >>= static_cast<mp_bitcnt_t>(-exponent);
}

/// N or N/D.
void take_fraction(std::string_view& text, mpq_class& number) {
  number.get_num() = from_digits(take_digits(text, 10), 10);
  if (!take(text, "/")) return;
  number.get_den() = from_digits(take_digits(text, 10), 10);
  if (number.get_den() == 0) reject("a denominator that is 0");
  number.canonicalize();
}

mpq_class parse(std::string_view word, bool is_integer = false) {
  try {
    std::string_view text = word;
    const bool is_negative = take(text, "-");
    mpq_class number;
    if (is_integer) {
      number.get_num() = from_digits(take_digits(text, 10), 10);
    } else {
      take(text, "0x") ? take_hexadecimal(text, number) : take_fraction(text, number);
    }
    if (!text.empty()) reject(is_integer ? "not an integer" : "not a number");
    if (is_negative) number = -number;
    return number;
  } catch (const Rejected& rejected) {
    reject(rejected.reason + ": " + quoted(word));
  }
}

// ---- The parts of a certificate -----------------------------------------------------------------

void read_query(Reader& reader, Certificate& certificate) {
  reader.begin("query");
  certificate.is_edge_edge = reader.one_of({"vertex_face", "edge_edge"}) == 1;
  reader.end();
  if (reader.is_line() && reader.first_word() == "label") {
    const std::string_view text = reader.text();
    certificate.label = text.substr(std::min<std::size_t>(6, text.size()));
    if (certificate.label.size() > max_label_bytes) {
      reject("a label of more than " + std::to_string(max_label_bytes) + " bytes");
    }
    reader.advance();
  }
  for (std::size_t n = 0; n < certificate.coordinates.size(); ++n) {
    if (n % 3 == 0) reader.begin("point");
    certificate.coordinates[n] = parse(reader.word());
    if (n % 3 == 2) reader.end();
  }
  if (!reader.is_line() || reader.first_word() != "separation") return;
  reader.begin("separation");
  certificate.distance = parse(reader.word());
  if (certificate.distance < 0) reject("a distance below 0");
  certificate.is_l2 = reader.one_of({"linf", "l2"}) == 1;
  reader.end();
}

void read_claim(Reader& reader, Certificate& certificate) {
  certificate.line = reader.number();
  reader.begin("claim");
  certificate.claim = Claim(reader.one_of({"no_collision", "collision", "time_of_impact"}));
  if (certificate.claim == Claim::time_of_impact) {
    certificate.lower = parse(reader.word());
    certificate.upper = parse(reader.word());
  }
  reader.end();
}

std::size_t read_corner(Reader& reader, const Certificate& certificate) {
  const std::size_t corner = reader.one_of({"0", "1", "2", "3"});
  if (corner == 3 && !certificate.is_edge_edge) reject("a vertex_face has no corner 3");
  return corner;
}

void read_piece(Reader& reader, Certificate& certificate) {
  if (certificate.pieces.size() == max_pieces) {
    reject("more than " + std::to_string(max_pieces) + " pieces");
  }
  Piece& piece = certificate.pieces.emplace_back();
  piece.line = reader.number();
  reader.begin("separate");
  piece.from = parse(reader.word());
  piece.to = parse(reader.word());
  piece.feature = Feature(reader.one_of({"vertex", "edge", "face", "axis", "cross"}));
  if (piece.feature >= Feature::axis) piece.axis = reader.one_of({"x", "y", "z"});
  if (piece.feature == Feature::face || piece.feature == Feature::axis) {
    piece.is_negative = reader.one_of({"+", "-"}) == 1;
  } else {
    piece.i = read_corner(reader, certificate);
    if (piece.feature != Feature::vertex) piece.j = read_corner(reader, certificate);
  }
  reader.end();
}

void read_contact(Reader& reader, Certificate& certificate) {
  Contact& contact = certificate.contact;
  contact.line = reader.number();
  reader.begin("contact");
  contact.is_root = reader.one_of({"time", "root"}) == 1;
  contact.from = parse(reader.word());
  contact.to = contact.is_root ? parse(reader.word()) : contact.from;
  while (contact.is_root && reader.has_word()) {
    if (contact.g.size() > max_root_degree) {
      reject("a polynomial of a degree above " + std::to_string(max_root_degree));
    }
    contact.g.push_back(parse(reader.word(), true).get_num());
  }
  if (contact.is_root && contact.g.size() < 2) reject("a polynomial of a degree below 1");
  if (contact.is_root && contact.g.back() == 0)
    reject("a polynomial whose leading coefficient is 0");
  reader.end();
  reader.begin("at");
  contact.place = Place(reader.one_of({"vertex", "segment", "triangle", "edge", "face", "axes"}));
  static constexpr std::array<std::size_t, 6> counts{1, 2, 3, 2, 0, 0};
  for (std::size_t n = 0; n < counts.at(std::size_t(contact.place)); ++n) {
    contact.corners.at(n) = read_corner(reader, certificate);
  }
  if (contact.place == Place::triangle) contact.axis = reader.one_of({"x", "y", "z"});
  reader.end();
}

}  // namespace

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

void Reader::advance() {
  do {
    stream_->getline(buffer_.data(), std::ssize(buffer_));
    auto length = static_cast<std::size_t>(stream_->gcount());
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
    text_ = {buffer_.data(), length};
  } while (number_ > 1 && fault_ == nullptr && (text_.empty() || text_.front() == '#'));
}

void Reader::begin(std::string_view keyword) {
  if (fault_ != nullptr) reject(fault_);
  if (first_word() != keyword) {
    reject("expected '" + std::string(keyword) + "', found " + quoted(first_word()));
  }
  rest_ = text_.substr(keyword.size());
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

void read_certificate(Reader& reader, Certificate& certificate) {
  read_query(reader, certificate);
  read_claim(reader, certificate);
  if (certificate.claim != Claim::collision) {
    while (reader.first_word() == "separate") read_piece(reader, certificate);
  }
  if (certificate.claim != Claim::no_collision) read_contact(reader, certificate);
  reader.begin("end");
  reader.end();
}

}  // namespace touchstone::checker

#include "verify/data/plain_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "touchstone/number.hpp"

namespace touchstone::verify::data {
namespace {

constexpr std::size_t word_bytes = 8;

// ---- Words of digits ----------------------------------------------------------------------------

/// Eight characters, the first one in the lowest byte.
std::uint64_t word_at(const char* text) {
  std::uint64_t word = 0;
  std::memcpy(&word, text, sizeof word);
  if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
  return word;
}

/// The number of digits that begin a word.
std::size_t digits_of(std::uint64_t word) {
  constexpr std::uint64_t high_halves = 0xF0F0F0F0F0F0F0F0, zeros = 0x3030303030303030;
  constexpr std::uint64_t sixes = 0x0606060606060606;
  // '0' to '9' are 0x30 to 0x39: with 6 added their upper half stays 3. A carry into the next byte
  // comes only from a byte that is no digit itself.
  const std::uint64_t others =
      ((word & high_halves) ^ zeros) | (((word + sixes) & high_halves) ^ zeros);
  return static_cast<std::size_t>(std::countr_zero(others)) / 8;
}

/// The number of eight digits.
std::uint64_t number_of(std::uint64_t word) {
  word = (word & 0x0F0F0F0F0F0F0F0F) * (10 * 256 + 1) >> 8U;
  word = (word & 0x00FF00FF00FF00FF) * (100 * 65536 + 1) >> 16U;
  return (word & 0x0000FFFF0000FFFF) * (10000 * (std::uint64_t{1} << 32U) + 1) >> 32U;
}

template <std::uint64_t base, std::size_t count>
constexpr std::array<std::uint64_t, count> powers() {
  std::array<std::uint64_t, count> result{1};
  for (std::size_t i = 1; i < count; ++i) result[i] = base * result[i - 1];
  return result;
}
constexpr auto powers_of_5 = powers<5, 28>();
constexpr auto powers_of_10 = powers<10, 20>();

/// A position in a text, and the first one at which no word can be read.
struct Cursor {
  const char* at;
  const char* end;

  /// Appends the digits here to a number of `count` digits, without zeros in front. Returns false
  /// if these are more than 19 then, or at the end.
  bool take_digits(std::uint64_t& number, std::size_t& count) {
    while (number == 0 && at < end && *at == '0') ++at;
    for (;;) {
      if (at >= end) return false;
      const std::uint64_t word = word_at(at);
      const std::size_t digits = digits_of(word);
      if (digits == 0) return true;
      // The digits become the last ones of eight, with zeros in front.
      const std::uint64_t part = number_of(word << (8 * (word_bytes - digits)));
      count += digits;
      if (count > 19) return false;
      number = number * powers_of_10[digits] + part;
      at += digits;
      if (digits < word_bytes) return true;
    }
  }

  void skip_spaces() {
    while (at < end && *at == ' ') ++at;
  }

  bool take(char c) {
    if (*at != c) return false;
    ++at;
    return true;
  }
};

// ---- Numbers ------------------------------------------------------------------------------------

/// The least power of two that takes no whole number below the normal doubles.
constexpr int least_exponent = -1021;

/// A whole number times a power of two, both doubles. \pre least_exponent ≤ exponent ≤ 0
double scaled(double whole, int exponent) {
  return whole * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52U);
}

/// A number ±m·10^e as a text has it.
struct WrittenNumber {
  std::uint64_t digits;  ///< below 10^19
  int exponent;          ///< of ten
  bool is_negative;
};

/// A double times a power of two, which need not be one.
struct Dyadic {
  double whole;
  int exponent;
};

enum class Exactness : std::uint8_t { exact, inexact, unknown };

/// Tells whether the magnitude of a number is dyadic with at most 53 significant bits, and sets it.
Exactness make_dyadic(const WrittenNumber& number, Dyadic& dyadic) {
  const int exponent = number.exponent;
  std::uint64_t whole = number.digits;
  if (exponent < 0 && whole != 0) {
    // (5^28 is greater than all digits.)
    if (exponent <= -static_cast<int>(powers_of_5.size())) return Exactness::inexact;
    const std::uint64_t divisor = powers_of_5[static_cast<std::size_t>(-exponent)];
    if (whole % divisor != 0) return Exactness::inexact;
    whole /= divisor;
  } else if (exponent > 0) {
    if (exponent >= static_cast<int>(powers_of_10.size()) ||
        __builtin_mul_overflow(whole, powers_of_10[static_cast<std::size_t>(exponent)], &whole)) {
      return Exactness::unknown;
    }
  }
  dyadic = {.whole = static_cast<double>(whole), .exponent = std::min(exponent, 0)};
  const int bits =
      static_cast<int>(std::bit_width(whole)) - std::countr_zero(whole | std::uint64_t{1} << 63U);
  return bits > 53 ? Exactness::inexact : Exactness::exact;
}

/// Reads digits with an optional point and an optional exponent. Returns false if there are none,
/// or too many.
bool take_decimal(Cursor& cursor, WrittenNumber& number) {
  cursor.skip_spaces();
  number = {.digits = 0, .exponent = 0, .is_negative = cursor.take('-')};
  std::size_t count = 0;
  const char* const first = cursor.at;
  if (!cursor.take_digits(number.digits, count)) return false;
  auto characters = static_cast<std::size_t>(cursor.at - first);
  if (cursor.take('.')) {
    const char* const fraction = cursor.at;
    if (!cursor.take_digits(number.digits, count)) return false;
    characters += static_cast<std::size_t>(cursor.at - fraction);
    number.exponent = -static_cast<int>(cursor.at - fraction);
  }
  if (characters == 0) return false;
  if (*cursor.at != 'e' && *cursor.at != 'E') return true;
  ++cursor.at;
  const bool is_below_one = cursor.take('-');
  if (!is_below_one) cursor.take('+');
  std::uint64_t exponent = 0;
  count = 0;
  const char* const exponent_digits = cursor.at;
  if (!cursor.take_digits(exponent, count) || cursor.at == exponent_digits || exponent > 999) {
    return false;
  }
  number.exponent += is_below_one ? -static_cast<int>(exponent) : static_cast<int>(exponent);
  return true;
}

// ---- Powers of two ------------------------------------------------------------------------------

/// The powers of two as texts.
class PowersOfTwo {
 public:
  PowersOfTwo() {
    for (int exponent = 0; exponent <= greatest; ++exponent) {
      std::string digits = exact::power_of_two(exponent).get_str();
      if (digits.size() >= by_length_.size()) by_length_.resize(digits.size() + 1);
      Text& text = by_length_[digits.size()][static_cast<std::size_t>(digits.front() - '0')];
      text = {.digits = std::move(digits), .exponent = exponent};
    }
  }

  /// The exponent of the power that the digits here are; nothing if they are none, or end the text.
  static std::optional<int> take(Cursor& cursor) {
    static const PowersOfTwo all;
    cursor.skip_spaces();
    const char* last = cursor.at;
    for (;;) {
      if (last >= cursor.end) return std::nullopt;
      const std::size_t digits = digits_of(word_at(last));
      last += digits;
      if (digits < word_bytes) break;
    }
    const auto length = static_cast<std::size_t>(last - cursor.at);
    if (length == 0 || length >= all.by_length_.size()) return std::nullopt;
    const Text& text = all.by_length_[length][static_cast<std::size_t>(*cursor.at - '0')];
    if (text.digits.empty() || std::memcmp(text.digits.data(), cursor.at, length) != 0) {
      return std::nullopt;
    }
    cursor.at = last;
    return text.exponent;
  }

 private:
  struct Text {
    std::string digits;  ///< none if there is no such power
    int exponent;
  };

  static constexpr int greatest = -least_exponent;
  /// The texts by their number of digits and the first digit.
  std::vector<std::array<Text, 10>> by_length_;
};

// ---- Rows ---------------------------------------------------------------------------------------

/// Reads a coordinate and the character that ends it.
class Reader {
 public:
  Reader(std::string_view text, std::size_t columns, bool round)
      : cursor_{text.data(), text.data() + text.size() - plain_rows_margin},
        has_denominators_(columns >= 6),
        has_labels_(columns == 4 || columns == 7),
        round_(round) {}

  [[nodiscard]] std::optional<PlainRows> read() {
    const char* const begin = cursor_.at;
    PlainRows rows{.query = {}, .label = std::nullopt, .rounded = 0, .bytes = 0};
    for (std::size_t row = 0; row < query_points; ++row) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis != 0 && !cursor_.take(',')) return std::nullopt;
        if (!take_coordinate(rows.query.coordinates[3 * row + axis], rows)) return std::nullopt;
      }
      if (has_labels_ && !take_label(rows.label)) return std::nullopt;
      cursor_.take('\r');
      if (!cursor_.take('\n') || cursor_.at > cursor_.end) return std::nullopt;
    }
    rows.bytes = static_cast<std::size_t>(cursor_.at - begin);
    return rows;
  }

 private:
  bool take_coordinate(double& value, PlainRows& rows) {
    const char* const begin = cursor_.at;
    WrittenNumber number{};
    if (!take_decimal(cursor_, number)) return false;
    const char* const end = cursor_.at;
    int of_two = 0;
    if (has_denominators_) {
      if (!cursor_.take(',')) return false;
      const std::optional<int> denominator = PowersOfTwo::take(cursor_);
      if (!denominator) return false;
      of_two = -*denominator;
    }
    Dyadic dyadic{};
    const Exactness exactness = make_dyadic(number, dyadic);
    if (exactness == Exactness::exact) {
      if (dyadic.exponent + of_two < least_exponent) return false;
      const double magnitude = scaled(dyadic.whole, dyadic.exponent + of_two);
      value = (number.is_negative ? -magnitude : magnitude) + 0.0;  // +0 instead of −0
      return true;
    }
    ++rows.rounded;
    return round_ && exactness == Exactness::inexact && of_two == 0 && round(begin, end, value);
  }

  /// The nearest double, if it is a normal number.
  static bool round(const char* begin, const char* end, double& value) {
    while (*begin == ' ') ++begin;
    const auto [stop, error] = std::from_chars(begin, end, value);
    return error == std::errc() && stop == end && std::abs(value) >= 0x1p-1022;
  }

  bool take_label(std::optional<bool>& label) {
    if (!cursor_.take(',')) return false;
    const bool collides = *cursor_.at == '1';
    if ((!collides && *cursor_.at != '0') || label.value_or(collides) != collides) return false;
    label = collides;
    ++cursor_.at;
    return true;
  }

  Cursor cursor_;
  bool has_denominators_;
  bool has_labels_;
  bool round_;
};

}  // namespace

std::optional<PlainRows> read_plain_rows(std::string_view text, std::size_t columns, bool round) {
  if (text.size() <= plain_rows_margin) return std::nullopt;
  return Reader(text, columns, round).read();
}

}  // namespace touchstone::verify::data

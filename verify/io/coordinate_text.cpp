#include "verify/io/coordinate_text.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <system_error>

#include "touchstone/number.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::io {
namespace {

using Part = CoordinateError::Part;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// n / 2^k with |n| ≤ 2^53 and k < 64, which a division of doubles gives; nothing of other texts.
std::optional<double> plain_quotient(std::string_view numerator, std::string_view denominator) {
  constexpr std::int64_t greatest = std::int64_t{1} << std::numeric_limits<double>::digits;
  const auto n = number_from_text<std::int64_t>(numerator);
  if (!n || *n < -greatest || *n > greatest) return std::nullopt;
  const auto d = number_from_text<std::uint64_t>(denominator);
  if (!d || !std::has_single_bit(*d)) return std::nullopt;
  return static_cast<double>(*n) / static_cast<double>(*d);
}

/// What the standard library makes of a text: empty if it is no number.
std::optional<double> standard_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end) return std::nullopt;
  return value;
}

exact::Rational any_number(std::string_view text, Part part) {
  try {
    return exact::rational_from_decimal(text);
  } catch (const std::invalid_argument&) {
    throw CoordinateError(part, fault_of_decimal(text));
  }
}

}  // namespace

ParsedCoordinate parse_coordinate(std::string_view numerator, std::string_view denominator) {
  if (const auto plain = plain_quotient(numerator, denominator)) {
    return {.value = *plain, .exact = true};
  }
  exact::Rational quotient = any_number(numerator, Part::numerator);
  const exact::Rational divisor = any_number(denominator, Part::denominator);
  if (divisor == 0) throw CoordinateError(Part::denominator, "zero denominator");
  quotient /= divisor;
  const double value = exact::round_to_nearest(quotient);
  if (std::isinf(value)) {
    throw CoordinateError(Part::numerator, "beyond the range of double");
  }
  return {.value = value, .exact = exact::Rational(value) == quotient};
}

std::string fault_of_decimal(std::string_view text) {
  const std::optional<double> value = standard_number(text);
  if (value && std::isfinite(*value))
    return "beyond the range, exponents up to 10000: " + quote(text);
  return (value ? "not a finite number: " : "not a number: ") + quote(text);
}

bool is_numeric(std::string_view text) {
  const std::size_t start = text.find_first_not_of("+-.");
  if (start != std::string_view::npos && is_digit(text[start])) return true;
  return !std::isfinite(standard_number(text).value_or(0.0));
}

void append_coordinate(std::string& text, double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a coordinate must be finite");
  const exact::Rational exact_value(value);
  text += exact_value.get_num().get_str();
  text += ',';
  text += exact_value.get_den().get_str();
}

}  // namespace touchstone::verify::io

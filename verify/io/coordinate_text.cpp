#include "verify/io/coordinate_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "touchstone/number.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::io {
namespace {

using Part = CoordinateError::Part;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The text as an integer of any length; empty if it is none.
std::optional<exact::Integer> any_integer(std::string_view text) {
  const bool has_sign = text.starts_with('-') || text.starts_with('+');
  const std::string_view digits = text.substr(has_sign ? 1 : 0);
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), is_digit)) return std::nullopt;
  exact::Integer magnitude(std::string(digits), 10);
  return text.starts_with('-') ? exact::Integer(-magnitude) : magnitude;
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

/// The quotient if it is a double and the denominator a power of two: odd · 2^exponent, where `odd`
/// fits a significand and the bits lie between the ends of the range. Nothing otherwise.
std::optional<double> dyadic_quotient(const exact::Integer& n, const exact::Integer& d) {
  using Limits = std::numeric_limits<double>;
  if (n == 0) return 0.0;
  if (d < 0 || mpz_popcount(d.get_mpz_t()) != 1) return std::nullopt;
  const auto zeros = [](const exact::Integer& x) {
    return static_cast<long>(mpz_scan1(x.get_mpz_t(), 0));
  };
  const auto bits = static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2)) - zeros(n);
  const long exponent = zeros(n) - zeros(d);
  if (bits > Limits::digits || exponent < Limits::min_exponent - Limits::digits ||
      bits + exponent > Limits::max_exponent) {
    return std::nullopt;
  }
  const exact::Integer odd = n >> static_cast<mp_bitcnt_t>(zeros(n));
  return std::ldexp(odd.get_d(), static_cast<int>(exponent));
}

}  // namespace

ParsedCoordinate parse_coordinate(std::string_view numerator, std::string_view denominator) {
  const std::optional<exact::Integer> n = any_integer(numerator), d = any_integer(denominator);
  if (n && d && *d != 0) {
    if (const auto value = dyadic_quotient(*n, *d)) return {.value = *value, .exact = true};
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

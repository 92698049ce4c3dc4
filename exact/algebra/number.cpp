#include "touchstone/number.hpp"

#include <CGAL/Exact_integer.h>
#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace touchstone::exact {

static_assert(std::is_same_v<Integer, CGAL::Exact_integer> &&
                  std::is_same_v<Rational, CGAL::Exact_rational>,
              "CGAL must choose GMP's C++ classes: install libgmpxx and define CGAL_USE_GMPXX");

namespace {

using Limits = std::numeric_limits<double>;

/// Exponent of the unit in which doubles of magnitude |x| are whole numbers, subnormals included.
long unit_exponent(const Rational& x) {
  const auto bits = [](const Integer& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2));
  };
  long exponent = bits(x.get_num()) - bits(x.get_den());  // 2^(exponent-1) < |x| < 2^(exponent+1)
  if (abs(x) >= power_of_two(exponent)) ++exponent;
  return std::max(exponent - Limits::digits,
                  static_cast<long>(Limits::min_exponent - Limits::digits));
}

/// floor(x / 2^unit) as an integer.
Integer floor_in_units(const Rational& x, long unit) {
  Integer numerator = x.get_num(), denominator = x.get_den();
  if (unit < 0) {
    numerator <<= static_cast<unsigned long>(-unit);
  } else {
    denominator <<= static_cast<unsigned long>(unit);
  }
  Integer quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  return quotient;
}

/// units · 2^unit, where |units| ≤ 2^53: exact, or ±∞ past the finite range.
double from_units(const Integer& units, long unit) {
  return std::ldexp(units.get_d(), static_cast<int>(std::min(unit, 2000L)));
}

}  // namespace

Rational power_of_two(long exponent) {
  Integer power = 1;
  power <<= static_cast<unsigned long>(std::labs(exponent));
  return exponent >= 0 ? Rational(power) : Rational(Integer(1), power);
}

double round_down(const Rational& x) {
  if (sgn(x) == 0) return 0.0;
  const long unit = unit_exponent(x);
  const double result = from_units(floor_in_units(x, unit), unit);
  return result == Limits::infinity() ? Limits::max() : result;
}

double round_up(const Rational& x) {
  const double result = -round_down(-x);
  return result == 0.0 ? 0.0 : result;
}

double round_to_nearest(const Rational& x) {
  if (sgn(x) == 0) return 0.0;
  const long unit = unit_exponent(x);
  Integer units = floor_in_units(x, unit);
  const Rational rest = x / power_of_two(unit) - units;
  const int above_half = cmp(rest, Rational(1, 2));
  if (above_half > 0 || (above_half == 0 && mpz_odd_p(units.get_mpz_t()) != 0)) ++units;
  return from_units(units, unit);
}

Rational rational_from_decimal(std::string_view text) {
  static constexpr long exponent_limit = 10000;
  const auto fail = [&] {
    throw std::invalid_argument("not a decimal number: " + std::string(text));
  };
  std::size_t at = 0;
  const auto peek = [&] { return at < text.size() ? text[at] : '\0'; };
  const auto sign = [&] {
    const bool negative = peek() == '-';
    if (negative || peek() == '+') ++at;
    return negative;
  };
  const auto digits = [&](std::string& into) {
    const std::size_t from = at;
    while (std::isdigit(static_cast<unsigned char>(peek())) != 0) into += text[at++];
    return static_cast<long>(at - from);
  };

  const bool negative = sign();
  std::string mantissa;
  long count = digits(mantissa), exponent = 0;
  if (peek() == '.') {
    ++at;
    exponent = -digits(mantissa);
    count -= exponent;
  }
  if (count == 0) fail();
  if (peek() == 'e' || peek() == 'E') {
    ++at;
    const bool negative_exponent = sign();
    std::string value;
    if (digits(value) == 0) fail();
    value.erase(0, std::min(value.find_first_not_of('0'), value.size() - 1));
    if (value.size() > 5 || std::stol(value) > exponent_limit) fail();
    exponent += negative_exponent ? -std::stol(value) : std::stol(value);
  }
  if (at != text.size()) fail();

  Integer scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, static_cast<unsigned long>(std::labs(exponent)));
  const Integer digits_value(mantissa, 10);
  Rational result = exponent >= 0 ? Rational(digits_value * scale) : Rational(digits_value, scale);
  result.canonicalize();
  return negative ? Rational(-result) : result;
}

}  // namespace touchstone::exact

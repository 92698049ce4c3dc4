#include "verify/data/toi_writer.hpp"

#include <fmt/core.h>

#include <stdexcept>
#include <utility>

namespace touchstone::verify::data {
namespace {

exact::Integer power_of_ten(long exponent) {
  exact::Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(exponent));
  return power;
}

/// x · 10^exponent.
exact::Rational scaled(const exact::Rational& x, long exponent) {
  return exponent >= 0 ? exact::Rational(x * power_of_ten(exponent))
                       : exact::Rational(x / power_of_ten(-exponent));
}

/// A positive number as `digits` · 10^exponent.
struct Decimal {
  exact::Integer digits;
  long exponent;
};

/// n / 2^k = n · 5^k / 10^k.
Decimal exact_decimal(const exact::Rational& x) {
  const auto k = mpz_scan1(x.get_den_mpz_t(), 0);
  exact::Integer factor;
  mpz_ui_pow_ui(factor.get_mpz_t(), 5, k);
  return {.digits = x.get_num() * factor, .exponent = -static_cast<long>(k)};
}

Decimal rounded_decimal(const exact::Rational& x, long digits) {
  const auto decimal_digits = [](const exact::Integer& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 10));
  };
  // sizeinbase may be one too large, so the quotient's length is known but for one digit each way.
  long exponent = decimal_digits(x.get_num()) - decimal_digits(x.get_den()) + 1 - digits;
  while (scaled(x, -exponent) < power_of_ten(digits - 1)) --exponent;
  while (scaled(x, -exponent) >= power_of_ten(digits)) ++exponent;
  const exact::Rational shifted = scaled(x, -exponent) + exact::Rational(1, 2);
  return {.digits = shifted.get_num() / shifted.get_den(), .exponent = exponent};
}

/// value ≠ 0 has the sign of `value` and the magnitude of `decimal`.
std::string text(const exact::Rational& value, const Decimal& decimal) {
  const std::string digits = decimal.digits.get_str();
  std::string mantissa = digits.substr(0, digits.find_last_not_of('0') + 1);
  if (mantissa.size() > 1) mantissa.insert(1, ".");
  const long exponent = decimal.exponent + static_cast<long>(digits.size()) - 1;
  return (value < 0 ? "-" : "") + mantissa + "E" + std::to_string(exponent);
}

}  // namespace

std::string to_decimal(const exact::Rational& value, unsigned significant_digits) {
  if (value == 0) return "0";
  return text(value, rounded_decimal(abs(value), significant_digits));
}

std::string to_decimal(const exact::Rational& value) {
  if (value == 0) return "0";
  const bool dyadic = mpz_popcount(value.get_den_mpz_t()) == 1;
  if (!dyadic) return to_decimal(value, rounded_digits);
  return text(value, exact_decimal(abs(value)));
}

ToiWriter::ToiWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write("query,toi\n");
}

void ToiWriter::write(std::uint64_t query, const exact::Rational& toi) {
  if (last_query_ && query <= *last_query_) {
    throw std::invalid_argument("query numbers must ascend");
  }
  file_.write(fmt::format("{},{}\n", query, to_decimal(toi)));
  last_query_ = query;
}

}  // namespace touchstone::verify::data

#include "verify/generate/decimal.hpp"

#include <array>
#include <charconv>

namespace touchstone::verify::generate {

Decimal shortest_decimal(double x) {
  std::array<char, 32> text{};
  const char* const end =
      std::to_chars(text.begin(), text.end(), x, std::chars_format::scientific).ptr;
  Decimal result;
  const char* place = text.begin();
  for (; place != end && *place != 'e'; ++place) {
    if (*place == '.') continue;
    result.digits = 10 * result.digits + static_cast<std::uint64_t>(*place - '0');
    ++result.count;
  }
  // from_chars takes no plus.
  if (*++place == '+') ++place;
  std::from_chars(place, end, result.exponent);
  result.exponent -= result.count - 1;
  return result;
}

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

double from_decimal(std::uint64_t digits, int exponent) {
  std::array<char, 40> text{};
  char* end = std::to_chars(text.begin(), text.end(), digits).ptr;
  *end++ = 'e';
  end = std::to_chars(end, text.end(), exponent).ptr;
  double result = 0.0;
  std::from_chars(text.begin(), end, result);
  return result;
}

}  // namespace touchstone::verify::generate

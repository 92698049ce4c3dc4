#pragma once

/// \file
/// Decimals as people write them, and the doubles nearest to them.

#include <cstdint>

namespace touchstone::verify::generate {

/// The shortest decimal of a positive double: digits · 10^exponent, where the digits do not end in
/// 0.
struct Decimal {
  std::uint64_t digits = 0;
  int count = 0;  ///< of digits
  int exponent = 0;
};

/// \pre x is finite and positive
[[nodiscard]] Decimal shortest_decimal(double x);

/// 10^exponent. \pre 0 ≤ exponent ≤ 18
[[nodiscard]] std::int64_t power_of_ten(int exponent);

/// The double nearest to digits · 10^exponent.
[[nodiscard]] double from_decimal(std::uint64_t digits, int exponent);

}  // namespace touchstone::verify::generate

#pragma once

/// \file
/// The doubles of [0,1] as integers.
///
/// The bits of doubles that are not negative, read as integers, are in the order of the doubles. So
/// a number can be enclosed between doubles by questions "is it above this double?" alone, and no
/// floating-point arithmetic, with its rounding modes and flushed subnormals, takes part.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace touchstone::fast::exact_stage {

/// Bits of 0 and of 1.
inline constexpr std::uint64_t bits_of_zero = 0;
inline constexpr std::uint64_t bits_of_one = std::bit_cast<std::uint64_t>(1.0);
/// Of 2^-1022; those below, but for 0, are of subnormal doubles.
inline constexpr std::uint64_t bits_of_least_normal =
    std::bit_cast<std::uint64_t>(std::numeric_limits<double>::min());

/// The bits of the double in [0,1] nearest to the guess; of 0 for NaN.
[[nodiscard]] inline std::uint64_t unit_bits(double guess) {
  const auto bits = std::bit_cast<std::uint64_t>(guess);
  constexpr std::uint64_t infinity = 0x7FF0000000000000U;
  if (bits > infinity) return bits_of_zero;  // negative or NaN
  return std::min(bits, bits_of_one);
}

/// Doubles by their bits: lower < upper.
struct BitInterval {
  std::uint64_t lower = bits_of_zero;
  std::uint64_t upper = bits_of_one;
};

/// Doubles around a number α with 0 < α ≤ 1: lower < α ≤ upper, and `step` or fewer spacings apart.
/// `is_above(bits)` says whether α is above that double. Fast if α is near the guess, right in any
/// case. \pre step ≥ 1, and at most 2^52.
template <class IsAbove>
[[nodiscard]] BitInterval enclose(double guess, std::uint64_t step, IsAbove&& is_above) {
  BitInterval cell;
  const std::uint64_t start = unit_bits(guess);
  const std::uint64_t first = start > step / 2 ? start - step / 2 : bits_of_zero;
  if (first == bits_of_zero || is_above(first)) {
    cell.lower = first;
    for (std::uint64_t reach = step; cell.lower + reach < bits_of_one; reach *= 2) {
      const std::uint64_t next = cell.lower + reach;
      if (!is_above(next)) {
        cell.upper = next;
        break;
      }
      cell.lower = next;
    }
  } else {
    cell.upper = first;
    for (std::uint64_t reach = step; reach < cell.upper; reach *= 2) {
      const std::uint64_t next = cell.upper - reach;
      if (is_above(next)) {
        cell.lower = next;
        break;
      }
      cell.upper = next;
    }
  }
  while (cell.upper - cell.lower > step) {
    const std::uint64_t middle = cell.lower + (cell.upper - cell.lower) / 2;
    (is_above(middle) ? cell.lower : cell.upper) = middle;
  }
  return cell;
}

/// A double of [0,1] by its bits: numerator / 2^exponent.
struct DyadicDouble {
  std::int64_t numerator = 0;  ///< odd, or 0
  int exponent = 0;            ///< 0 to 1074
};

[[nodiscard]] inline DyadicDouble dyadic(std::uint64_t bits) {
  constexpr int significand_bits = 52, largest_exponent = 1075;
  const auto biased = static_cast<int>(bits >> significand_bits);
  std::uint64_t significand = bits & ((std::uint64_t{1} << significand_bits) - 1);
  if (biased != 0) significand |= std::uint64_t{1} << significand_bits;
  if (significand == 0) return {};
  const int zeros = std::countr_zero(significand);
  return {static_cast<std::int64_t>(significand >> static_cast<unsigned>(zeros)),
          largest_exponent - std::max(biased, 1) - zeros};
}

}  // namespace touchstone::fast::exact_stage

#pragma once

/// \file
/// Doubles as integers: no floating-point arithmetic, hence no effect of rounding modes and flushed
/// subnormals.
///
/// The bits of doubles that are not negative, read as integers, have the order of the doubles. So
/// comparisons with doubles suffice to enclose a number.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace touchstone::fast::exact_stage {

/// The bits of 0 and of 1.
inline constexpr std::uint64_t bits_of_zero = 0;
inline constexpr std::uint64_t bits_of_one = std::bit_cast<std::uint64_t>(1.0);
/// The bits of 2^-1022, the least normal double.
inline constexpr std::uint64_t bits_of_least_normal =
    std::bit_cast<std::uint64_t>(std::numeric_limits<double>::min());

/// The bits of the double in [0,1] nearest to the guess; those of 0 for NaN.
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
/// `is_above(bits)` is true if α is above that double. Fast if α is close to the guess, correct in
/// any case. \pre step ≥ 1, and at most 2^52.
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

/// A number numerator · 2^exponent.
struct BinaryFraction {
  std::int64_t numerator = 0;
  int exponent = 0;
};

inline constexpr int significand_bits = std::numeric_limits<double>::digits;

/// A finite double as a fraction; its numerator is below 2^53 in magnitude. Computed from its bits,
/// so that flushed subnormals have no effect.
[[nodiscard]] inline BinaryFraction binary_fraction(double x) {
  constexpr int stored_bits = significand_bits - 1, exponent_bias = 1075;
  constexpr std::uint64_t hidden_bit = std::uint64_t{1} << stored_bits, exponent_mask = 0x7FF;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto biased = static_cast<int>((bits >> stored_bits) & exponent_mask);
  auto significand = static_cast<std::int64_t>(bits & (hidden_bit - 1));
  if (biased != 0) significand |= static_cast<std::int64_t>(hidden_bit);
  return {(bits >> 63U) != 0 ? -significand : significand, std::max(biased, 1) - exponent_bias};
}

/// The same with an odd numerator; 0 · 2^0 for zero.
[[nodiscard]] inline BinaryFraction odd_fraction(double x) {
  const BinaryFraction fraction = binary_fraction(x);
  if (fraction.numerator == 0) return {};
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(fraction.numerator));
  return {fraction.numerator >> zeros, fraction.exponent + zeros};
}

}  // namespace touchstone::fast::exact_stage

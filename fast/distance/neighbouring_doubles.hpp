#pragma once

/// \file
/// The enclosure of a number ≥ 0 by neighbouring doubles, found by comparisons with doubles.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "touchstone/contacts.hpp"

namespace touchstone::fast {

/// The greatest double that is not above the number α and the least that is not below it. Both are
/// α if that is a double; the upper one is infinity beyond the greatest double. `sign_of(x)` is the
/// sign of α − x for a finite x ≥ 0, or empty if unknown; then the result is empty too. Fast if α
/// is close to the guess, correct in any case. \pre α ≥ 0.
template <class SignOf>
[[nodiscard]] std::optional<Distance> neighbouring_doubles(double guess, const SignOf& sign_of) {
  constexpr double greatest = std::numeric_limits<double>::max();
  constexpr auto last = std::bit_cast<std::uint64_t>(greatest);
  const auto at = [](std::uint64_t bits) { return std::bit_cast<double>(bits); };
  // NaN is not above 0.
  const auto start = std::bit_cast<std::uint64_t>(guess > 0.0 ? std::fmin(guess, greatest) : 0.0);
  std::optional<int> sign = sign_of(at(start));
  // The bits of doubles, which have the order of the doubles: one below α, and one above or after
  // the last.
  std::uint64_t lower = start, upper = start;
  if (sign && *sign > 0) {
    for (std::uint64_t stride = 1; sign && *sign > 0; stride *= 2) {
      lower = upper;
      if (lower == last) return Distance{greatest, std::numeric_limits<double>::infinity()};
      upper = lower + std::min(stride, last - lower);
      sign = sign_of(at(upper));
    }
    if (sign && *sign == 0) return Distance{at(upper), at(upper)};
  } else {
    for (std::uint64_t stride = 1; sign && *sign < 0; stride *= 2) {
      upper = lower;
      lower -= std::min(stride, lower);
      sign = sign_of(at(lower));
    }
    if (sign && *sign == 0) return Distance{at(lower), at(lower)};
  }
  while (sign && upper - lower > 1) {
    const std::uint64_t middle = lower + (upper - lower) / 2;
    sign = sign_of(at(middle));
    if (sign && *sign == 0) return Distance{at(middle), at(middle)};
    if (sign) (*sign > 0 ? lower : upper) = middle;
  }
  if (!sign) return std::nullopt;
  return Distance{at(lower), at(upper)};
}

}  // namespace touchstone::fast

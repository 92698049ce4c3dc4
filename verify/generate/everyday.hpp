#pragma once

/// \file
/// Everyday contacts: at the very beginning or end of a step, at features that both primitives
/// share, with coordinates up to 1e-3, 1e-2, … or 1e4 that are short decimals, as people type them
/// and exporters print them.
///
/// **Why they touch.** A scene is placed at one end of the step in whole units. There either a
/// point of one primitive is a point of the other, or lies on a side of it along an axis, or both
/// lie in one plane across an axis, one point inside the triangle or the edges across each other,
/// by more than a unit. The unit is a power of ten, and each coordinate the double nearest to that
/// decimal, or to the float nearest to it. Rounding keeps order and equality of coordinates, hence
/// the contact.

#include <cstdint>

#include "touchstone/any_kind.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

/// A query that touches at t=0 or at t=1, and may touch earlier, too. Half of those that share a
/// point then share it all the time. Coordinates are decimals of at most six digits, or the floats
/// nearest to them; the greatest is from 1e-4 to 1e4 in magnitude.
[[nodiscard]] Query everyday_contact(ContactKind kind, Random& random);

/// The same, but the first primitive is a unit away on one axis.
[[nodiscard]] Query everyday_near_contact(ContactKind kind, Random& random);

// Decimals as people write them, and the doubles nearest to them.

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

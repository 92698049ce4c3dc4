#pragma once

/// \file
/// Queries on curves that nearly touch, or just do, by a given amount.
///
/// A vertex is over the inside of a triangle, or an edge over a crossing one, at the height
/// ±(m (t−a/8)² q(t) + g), where q has Bernstein coefficients of 1 to 4. For g > 0 the distance is
/// never less than g, and is g at t = a/8; for g = 0 they touch there alone; for −1/64 ≤ g < 0 one
/// goes through the other, because the height has the other sign at the farther end, where
/// m (t−a/8)² q ≥ 1/4. m is the odd number that makes the control values, which are quotients by
/// binomials, binary fractions. A rotation is that of curved_families.hpp.
///
/// The whole is moved along a curve, and turned by the matrix of hardness.hpp, which multiplies
/// distances by 3. All numbers are multiples of 2^-38 below 2^13, so each step is exact.

#include <cstddef>

#include "verify/base/any_query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

/// Polynomial curves. \param gap g, a multiple of 2^-38 \pre 2 ≤ degree ≤ 8, −1/64 ≤ gap ≤ 1
[[nodiscard]] base::AnyQuery hard_curves(Kind kind, std::size_t degree, double gap, Random& random);

/// A rotation about an axis. \param gap by the radius, a multiple of 2^-36 \pre |gap| ≤ 1/64
[[nodiscard]] base::AnyQuery hard_rotation(Kind kind, double gap, Random& random);

}  // namespace touchstone::verify::generate

#pragma once

/// \file
/// Families of queries on curves of degree 2 or 3 whose truth is known by construction.
///
/// A vertex is above the inside of a triangle, or an edge above a crossing one, at the height h(t),
/// and the whole moves along a curve: the primitives touch where h = 0. h is a product of factors
/// t − a/8 and of constants, so its first root in [0,1] is known; its Bernstein coefficients times
/// binomial and 8^K are whole numbers.
///
/// Rotations are rational curves of degree 2. A body turns about an axis: at t, the tangent of half
/// the angle, its point at radius r is r (1−t², 2t) / (1+t²) across the axis, the curve of control
/// points r (1,0), r (1,1), r (0,1) and weights 1, 1, 2. For n = (64−a², 16a) with length 64 + a² =
/// r it satisfies n·x ≤ r², with equality at t = a/8 alone. It therefore touches a triangle or an
/// edge in the plane n·x = r² then, and misses one in the plane n·x = (1+g) r² by g r. All numbers
/// are multiples of 2^-38 below 2^11.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "touchstone/any_kind.hpp"
#include "verify/data/query_source.hpp"
#include "verify/generate/families.hpp"

namespace touchstone::verify::generate {

/// Draws query number `index` of a family on curves; to be called with 0, 1, 2, … in order.
/// \pre the family is one of curved_families()
[[nodiscard]] std::function<data::RecordedQuery(std::uint64_t index)> curved_draws(
    const Family& family, ContactKind kind, std::uint64_t seed);

/// The points of a query at a control point, before the whole is moved.
using Points = std::array<std::array<double, 3>, moving_points>;

/// The points at this height above the middle of a triangle or an edge.
[[nodiscard]] Points above(ContactKind kind, double height);

}  // namespace touchstone::verify::generate

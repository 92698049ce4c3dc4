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
/// points r (1,0), r (1,1), r (0,1) and weights 1, 1, 2. For n = (64−a², 16a) with length
/// 64 + a² = r it satisfies n·x ≤ r², with equality at t = a/8 alone. So it touches a triangle or
/// an edge of the plane n·x = r² then, and misses one of the plane n·x = (1+g) r² by g r. All
/// numbers are multiples of 2^-38 below 2^11.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::generate {

struct CurvedFamily {
  std::string_view name;
  Kind kind;
  std::size_t degree;
  /// As CurvedQueries.
  std::vector<double> numbers;
  /// For each query the exact time of impact; nothing if it does not collide.
  std::vector<std::optional<double>> toi;
  bool is_rational = false;

  [[nodiscard]] CurvedQueries queries() const { return {degree, is_rational, numbers}; }
};

/// So many queries of each family and kind: transversal, tangential, at_start, at_end, twice
/// (through and back), in_plane (h = 0 throughout, the vertex enters the triangle, or one edge the
/// other's way), near_miss (a tangent 2^-20 away), and of degree 2 rotation_touch and rotation_miss
/// (by 2^-10 to 2^-36 of the radius). \pre degree 2 or 3
[[nodiscard]] std::vector<CurvedFamily> curved_families(std::size_t degree, std::size_t count,
                                                        std::uint64_t seed);

}  // namespace touchstone::verify::generate

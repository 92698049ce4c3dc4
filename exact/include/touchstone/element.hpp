#pragma once

/// \file
/// Moving elements of meshes, whose volumes are to stay positive.
///
/// A *tetrahedron* is a Query: its points a, b, c, d at t=0, then at t=1, each on a straight line
/// in between. Six times its signed volume is
///
///     6 V = det(b − a, c − a, d − a),
///
/// positive if d is on the side of the triangle a, b, c from which that is seen counterclockwise.
/// A *triangle in the plane* has points a, b, c, and twice its signed area is det(b − a, c − a),
/// positive if they are counterclockwise. An element *inverts* if its volume or area is 0 or
/// negative at some time in [0,1].
///
/// **A triangle is a tetrahedron.** With d = b + (0,0,1) at all times, 6 V = det(b − a, c − a) =
/// 2 A. So all that is true of tetrahedra holds for triangles.
///
/// All functions are thread-safe.

#include <cstddef>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone {

/// The tetrahedron of a query about an element: the query itself, or the one with six times the
/// volume that the triangle has twice as area, at all times.
[[nodiscard]] inline Query to_tetrahedron(Kind kind, Query query) {
  if (kind != Kind::plane_triangle) return query;
  for (const std::size_t end : {0U, 1U}) {
    for (const std::size_t axis : {0U, 1U}) query.at(end, 3, axis) = query.at(end, 1, axis);
    for (std::size_t point = 0; point < moving_points; ++point) {
      query.at(end, point, 2) = point == 3 ? 1.0 : 0.0;
    }
  }
  return query;
}
[[nodiscard]] inline CurvedQuery to_tetrahedron(Kind kind, CurvedQuery query) {
  if (kind != Kind::plane_triangle) return query;
  query[3] = query[1];
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (auto& position : query[point].control) position[2] = point == 3 ? 1.0 : 0.0;
  }
  return query;
}

}  // namespace touchstone

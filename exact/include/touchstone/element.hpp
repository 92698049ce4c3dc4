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

#include <array>
#include <cstddef>
#include <type_traits>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone {

/// Three points that move in the plane, on straight lines: x and y of a, b and c at t=0, then at
/// t=1. An array of float64 of shape (N, 6, 2) is an array of these.
struct PlaneTriangle {
  static constexpr std::size_t points = 3;
  std::array<double, 4 * points> coordinates;

  /// Coordinate `axis` (0 or 1) of point `point` (0..2) at time `end` (0 or 1).
  [[nodiscard]] double at(std::size_t end, std::size_t point, std::size_t axis) const {
    return coordinates[2 * (points * end + point) + axis];
  }
  [[nodiscard]] double& at(std::size_t end, std::size_t point, std::size_t axis) {
    return coordinates[2 * (points * end + point) + axis];
  }

  friend bool operator==(const PlaneTriangle&, const PlaneTriangle&) = default;
};
static_assert(std::is_trivially_copyable_v<PlaneTriangle> && std::is_aggregate_v<PlaneTriangle>);

/// Three points that move in the plane on curves; their third coordinates have no effect.
using CurvedTriangle = std::array<Trajectory, PlaneTriangle::points>;

/// The tetrahedron with six times the volume that the triangle has twice as area, at all times.
[[nodiscard]] inline Query to_tetrahedron(const PlaneTriangle& triangle) {
  Query result{};
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t point = 0; point < PlaneTriangle::points; ++point) {
        result.at(end, point, axis) = triangle.at(end, point, axis);
      }
      result.at(end, 3, axis) = triangle.at(end, 1, axis);
    }
    result.at(end, 3, 2) = 1.0;
  }
  return result;
}
/// The triangle of a query of Kind::plane_triangle.
[[nodiscard]] inline PlaneTriangle to_plane_triangle(const Query& points) {
  PlaneTriangle result{};
  for (std::size_t end = 0; end < 2; ++end) {
    for (std::size_t point = 0; point < PlaneTriangle::points; ++point) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        result.at(end, point, axis) = points.at(end, point, axis);
      }
    }
  }
  return result;
}
[[nodiscard]] inline CurvedQuery to_tetrahedron(const CurvedTriangle& triangle) {
  CurvedQuery result{triangle[0], triangle[1], triangle[2], triangle[1]};
  for (std::size_t point = 0; point < result.size(); ++point) {
    for (auto& position : result[point].control) position[2] = point == 3 ? 1.0 : 0.0;
  }
  return result;
}

}  // namespace touchstone

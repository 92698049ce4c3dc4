#pragma once

/// \file
/// Moving cells of meshes, whose volumes are to stay positive.
///
/// A *tetrahedron* has the points a, b, c, d of a Query at t=0, then at t=1, each on a straight
/// line in between. Six times its signed volume is
///
///     6 V = det(b − a, c − a, d − a),
///
/// positive if d is on the side of the triangle a, b, c from which that is seen counterclockwise.
/// A *triangle in the plane* has points a, b, c, and twice its signed area is det(b − a, c − a),
/// positive if they are counterclockwise. A cell *inverts* if its volume or area is 0 or negative
/// at some time in [0,1].
///
/// **A triangle is a tetrahedron.** With d = b + (0,0,1) at all times, 6 V = det(b − a, c − a) =
/// 2 A. So all that is true of tetrahedra holds for triangles.
///
/// All functions are thread-safe.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone {

enum class CellKind : std::uint8_t {
  tetrahedron,
  plane_triangle,  ///< x and y of the first three points; the other coordinates have no effect
};

/// A kind of cells.
struct CellRecord {
  std::string_view name;     ///< as data sets and the command line spell it
  std::string_view keyword;  ///< in certificates
  std::string_view list;     ///< the keyword of a list of them there
  std::size_t point_count;   ///< of a mesh; a query has four, of which these are the first
  std::size_t dimension;     ///< the number of axes that have an effect, from the first on
};
/// By CellKind.
inline constexpr std::array<CellRecord, 2> cell_records{
    {{"tetrahedron", "tetrahedron", "tetrahedra", 4, 3},
     {"plane-triangle", "plane_triangle", "plane_triangles", 3, 2}}};
inline constexpr std::array cell_kinds{CellKind::tetrahedron, CellKind::plane_triangle};
static_assert(cell_kinds.size() == cell_records.size());

[[nodiscard]] constexpr const CellRecord& record_of(CellKind kind) {
  return cell_records[static_cast<std::size_t>(kind)];
}
[[nodiscard]] constexpr std::string_view to_string(CellKind kind) { return record_of(kind).name; }

using CellShape = Shape<CellKind>;
using Cells = Batch<CellKind>;

/// The tetrahedron of a cell: the cell itself, or the one with six times the volume that the
/// triangle has twice as area, at all times.
[[nodiscard]] inline Query to_tetrahedron(CellKind kind, Query query) {
  if (kind != CellKind::plane_triangle) return query;
  for (const std::size_t end : {0U, 1U}) {
    for (const std::size_t axis : {0U, 1U}) query.at(end, 3, axis) = query.at(end, 1, axis);
    for (std::size_t point = 0; point < moving_points; ++point) {
      query.at(end, point, 2) = point == 3 ? 1.0 : 0.0;
    }
  }
  return query;
}
[[nodiscard]] inline CurvedQuery to_tetrahedron(CellKind kind, CurvedQuery query) {
  if (kind != CellKind::plane_triangle) return query;
  query[3] = query[1];
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (auto& position : query[point].control) position[2] = point == 3 ? 1.0 : 0.0;
  }
  return query;
}

}  // namespace touchstone

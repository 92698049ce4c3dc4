#pragma once

/// \file
/// The function of Tight-Inclusion's `tight_inclusion/interval_root_finder.hpp` that programs call:
/// the filter of a scene. The searches themselves are omitted.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "tight_inclusion/types.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace ticcd {

/// The filter of a scene (touchstone/tight_inclusion.hpp), for the argument `err` of vertexFaceCCD
/// and edgeEdgeCCD, which are exact here and ignore it.
/// \param vertices no coordinate and no separation of a query is greater than theirs
inline Array3 get_numerical_error(const std::vector<Vector3>& vertices, const bool is_vertex_face,
                                  const bool using_minimum_separation) {
  std::array<double, 3> greatest{};
  for (const Vector3& vertex : vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = touchstone::to_double(vertex[static_cast<Eigen::Index>(axis)]);
      greatest[axis] = (std::max)(greatest[axis], std::abs(x));
    }
  }
  const std::array<double, 3> filter = touchstone::fast::error_filter(
      is_vertex_face ? touchstone::ContactKind::vertex_face : touchstone::ContactKind::edge_edge,
      greatest, using_minimum_separation ? (std::numeric_limits<double>::min)() : 0.0);
  return Eigen::Array3d(filter[0], filter[1], filter[2]).cast<Scalar>();
}

}  // namespace ticcd

#pragma once

/// \file
/// Meshes of Python's arguments.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "python/bindings/arguments.hpp"
#include "touchstone/step.hpp"

namespace touchstone::python {

/// The rows of an array of integers of shape (n, k), or of shape (n,) for k = 1.
template <class Row>
[[nodiscard]] std::vector<Row> rows_of(const Integers& array) {
  std::vector<Row> rows(std::size_t(array.shape(0)));
  if (!rows.empty()) std::memcpy(rows.data(), array.data(), rows.size() * sizeof(Row));
  return rows;
}

/// The motion between places of shape (n, 3); or on curves, of control points of shape (n, degree +
/// 1, 3) or, with weights, (n, degree + 1, 4), which are `before`.
[[nodiscard]] inline fast::Motion motion_of(const Doubles& before, const Doubles& after) {
  if (before.ndim() == 3) {
    return {std::size_t(before.shape(1)) - 1, before.shape(2) == 4,
            std::vector<double>(before.data(), before.data() + before.size())};
  }
  using Rows =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  return {Rows(before.data(), before.shape(0), before.shape(1)),
          Rows(after.data(), after.shape(0), after.shape(1))};
}

/// \throws std::invalid_argument unless there is a distance for each pair of groups.
[[nodiscard]] inline std::vector<fast::GroupSeparation> separations_from(const Integers& groups,
                                                                         const Doubles& distances) {
  const auto pairs = rows_of<std::array<std::int32_t, 2>>(groups);
  if (distances.ndim() != 1 || std::size_t(distances.size()) != pairs.size()) {
    throw std::invalid_argument("separations must have a distance for each pair of groups");
  }
  std::vector<fast::GroupSeparation> result;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    result.push_back({pairs[i], distances.data()[i]});
  }
  return result;
}

[[nodiscard]] inline fast::Mesh mesh_from(const Integers& faces, const Integers& edges,
                                          const Integers& points) {
  return {.edges = rows_of<fast::Edge>(edges),
          .faces = rows_of<fast::Face>(faces),
          .points = rows_of<std::int32_t>(points)};
}

/// Cells of each CellKind, in its order.
using CellLists = std::array<Integers, cell_kinds.size()>;

/// The same, with cells.
[[nodiscard]] inline fast::Mesh mesh_from(const Integers& faces, const Integers& edges,
                                          const Integers& points, const CellLists& cells) {
  fast::Mesh mesh = mesh_from(faces, edges, points);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    mesh.add_cells(cell_kinds[i], {cells[i].data(), std::size_t(cells[i].size())});
  }
  return mesh;
}

[[nodiscard]] inline fast::CollisionGroups groups_from(const Integers& groups,
                                                       const Integers& apart) {
  return {.of_vertices = rows_of<std::int32_t>(groups),
          .apart = rows_of<std::array<std::int32_t, 2>>(apart)};
}

/// The same, with the thickness of pairs.
[[nodiscard]] inline fast::CollisionGroups groups_from(const Integers& groups,
                                                       const Integers& apart, const Doubles& radii,
                                                       const Integers& separated,
                                                       const Doubles& separations) {
  fast::CollisionGroups result = groups_from(groups, apart);
  result.radii.assign(radii.data(), radii.data() + radii.size());
  result.separations = separations_from(separated, separations);
  return result;
}

}  // namespace touchstone::python

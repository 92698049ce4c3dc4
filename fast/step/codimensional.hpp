#pragma once

/// \file
/// The codimensional parts of a mesh: points without edges, and edges without faces.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// The vertices of all elements, each once, in order.
[[nodiscard]] std::vector<std::int32_t> vertices_of(std::size_t vertices, const Mesh& mesh);

/// The numbers of the edges that are not edges of faces, in order.
[[nodiscard]] std::vector<std::int32_t> edges_without_face(const Mesh& mesh);

struct Codimensional {
  /// The vertices without an edge, in order.
  std::vector<std::int32_t> points;
  /// The numbers of the edges without a face, in order; empty without points, because it is unused
  /// then.
  std::vector<std::int32_t> edges;
};

/// \param of_elements The result of vertices_of.
/// \pre All indices are in range, and `mesh.edges` contains the edges of the faces.
[[nodiscard]] Codimensional codimensional(std::size_t vertices,
                                          std::span<const std::int32_t> of_elements,
                                          const Mesh& mesh);

}  // namespace touchstone::fast

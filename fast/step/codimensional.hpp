#pragma once

/// \file
/// The codimensional parts of a mesh: what neither its faces nor its edges speak for.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast/mesh.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// The vertices of all elements, each once, in order.
[[nodiscard]] std::vector<std::int32_t> vertices_of(std::size_t vertices,
                                                    const MeshElements& elements);

struct Codimensional {
  /// Those of the vertices that have no edge, in order.
  std::vector<std::int32_t> points;
  /// The numbers of the edges that no face has, in order; of no use, and so none, without points.
  std::vector<std::int32_t> edges;
};

/// \param of_elements What vertices_of gives.
/// \pre All indices are in range, and `elements.edges` has the edges of the faces.
[[nodiscard]] Codimensional codimensional(std::size_t vertices,
                                          std::span<const std::int32_t> of_elements,
                                          const MeshElements& elements);

}  // namespace touchstone::fast

// FloatBounds as a function, which a fault in its source can be planted in.

#include "fast/broad_phase/float_bounds.cpp"

#include <vector>

namespace touchstone::fast {

std::vector<VertexBounds> vertex_bounds(const MovingVertices& vertices, double end);
std::vector<VertexBounds> vertex_bounds(const MovingVertices& vertices, double end) {
  const FloatBounds bounds(vertices, end);
  std::vector<VertexBounds> result;
  for (std::size_t i = 0; i < bounds.size(); ++i) result.push_back(bounds[i]);
  return result;
}

}  // namespace touchstone::fast

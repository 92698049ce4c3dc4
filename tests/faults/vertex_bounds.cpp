// FloatBounds as a function, so that a fault in its source can be planted.

#include "fast/broad_phase/float_bounds.cpp"

#include <vector>

namespace touchstone::fast {

std::vector<VertexBounds> vertex_bounds(const Motion& vertices, double end, double distance);
std::vector<VertexBounds> vertex_bounds(const Motion& vertices, double end, double distance) {
  const FloatBounds bounds(vertices, end, distance);
  std::vector<VertexBounds> result;
  for (std::size_t i = 0; i < bounds.size(); ++i) result.push_back(bounds[i]);
  return result;
}

}  // namespace touchstone::fast

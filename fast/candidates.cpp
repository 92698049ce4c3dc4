#include "fast/candidates.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

namespace touchstone::fast {
namespace {

template <class T>
const T& at(std::span<const T> items, std::int32_t index) {
  return items[static_cast<std::size_t>(index)];
}

bool is_below(std::int32_t index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// True if all indices are below the size. No branch for each, because it runs for every batch.
bool are_below(std::span<const std::int32_t> indices, std::size_t size) {
  std::uint32_t greatest = 0;  // a negative index becomes one of at least 2^31
  for (const std::int32_t index : indices) {
    greatest = std::max(greatest, static_cast<std::uint32_t>(index));
  }
  return indices.empty() || greatest < size;
}

void require_countable(std::size_t count, std::string_view name) {
  if (count <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) return;
  throw std::length_error(std::string(name) + ": more than 2^31-1 of them");
}

/// The vertices of elements of a mesh, so many of each, with their name in error messages.
void require_elements_in_range(std::size_t vertices, std::span<const std::int32_t> corners,
                               std::size_t of_each, std::string_view name) {
  require_countable(corners.size() / of_each, name);
  if (are_below(corners, vertices)) return;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (is_below(corners[i], vertices)) continue;
    throw std::out_of_range(std::string(name) + " " + std::to_string(i / of_each) + ": vertex " +
                            std::to_string(corners[i]) + ", but there are " +
                            std::to_string(vertices));
  }
}

template <std::size_t count>
void require_elements_in_range(std::size_t vertices,
                               std::span<const std::array<std::int32_t, count>> elements,
                               std::string_view name) {
  if (elements.empty()) return;
  require_elements_in_range(vertices, {elements.front().data(), count * elements.size()}, count,
                            name);
}

/// The vertices of a pair, in the order of a query's points.
std::array<std::int32_t, moving_points> vertices_of(const Candidates& candidates,
                                                    const IndexPair& pair) {
  const auto [first, second] = pair;
  if (candidates.kind == ContactKind::vertex_face) {
    const Face& face = at(candidates.faces, second);
    return {first, face[0], face[1], face[2]};
  }
  const Edge& a = at(candidates.edges, first);
  const Edge& b = at(candidates.edges, second);
  return {a[0], a[1], b[0], b[1]};
}

}  // namespace

Query query_of(const Motion& vertices, const Candidates& candidates, const IndexPair& pair) {
  return query_of(vertices, vertices_of(candidates, pair));
}

Query query_of(const Motion& vertices, const Tetrahedron& points) {
  Query query;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const MovingVertex& vertex = vertices[static_cast<std::size_t>(points[point])];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      query.at(0, point, axis) = vertex.start[axis];
      query.at(1, point, axis) = vertex.end[axis];
    }
  }
  return query;
}

void require_finite(const Motion& vertices) {
  require_countable(vertices.size(), "vertices");
  const bool has_weights = vertices.shape().is_rational;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    bool is_right = is_finite(vertices[i].start) && is_finite(vertices[i].end);
    if (!vertices.is_straight()) {
      const std::span<const double> points = vertices.control_points(i);
      is_right = is_finite(points);
      for (std::size_t k = 3; has_weights && k < points.size(); k += 4) {
        is_right = is_right && points[k] > 0.0;
      }
    }
    if (is_right) continue;
    throw std::domain_error("vertex " + std::to_string(i) + ": a coordinate is not finite" +
                            (has_weights ? ", or a weight is not positive and finite" : ""));
  }
}

void require_straight(const Motion& vertices, std::string_view what) {
  if (vertices.is_straight()) return;
  throw std::invalid_argument(std::string(what) + ": straight lines are needed, not curves");
}

void require_in_range(const Motion& vertices, std::span<const Edge> edges) {
  require_elements_in_range(vertices.size(), edges, "edge");
}

void require_in_range(const Motion& vertices, std::span<const Face> faces) {
  require_elements_in_range(vertices.size(), faces, "face");
}

void require_in_range(const Motion& vertices, std::span<const std::int32_t> points) {
  require_elements_in_range(vertices.size(), points, 1, "point");
}

void require_cells_in_range(const Motion& vertices, const Mesh& mesh) {
  for (const CellKind kind : cell_kinds) {
    require_elements_in_range(vertices.size(), mesh.corners_of(kind), record_of(kind).point_count,
                              to_string(kind));
  }
}

}  // namespace touchstone::fast

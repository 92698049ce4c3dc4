#include "fast/mesh.hpp"

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

/// Checks the indices of pairs, one pair after the other.
class RangeCheck {
 public:
  RangeCheck(const MovingVertices& vertices, const Candidates& candidates)
      : vertices_(vertices), candidates_(candidates) {}

  void require(std::size_t pair) const {
    const auto [first, second] = candidates_.pairs[pair];
    if (candidates_.kind == Kind::vertex_face) {
      if (!is_below(first, vertices_.size())) fail(pair, "vertex", first, vertices_.size());
      require_primitive(pair, "face", candidates_.faces, second);
    } else {
      require_primitive(pair, "edge", candidates_.edges, first);
      require_primitive(pair, "edge", candidates_.edges, second);
    }
  }

 private:
  template <class Primitive>
  void require_primitive(std::size_t pair, std::string_view name,
                         std::span<const Primitive> primitives, std::int32_t index) const {
    if (!is_below(index, primitives.size())) fail(pair, name, index, primitives.size());
    for (const std::int32_t vertex : at(primitives, index)) {
      if (is_below(vertex, vertices_.size())) continue;
      fail(pair, std::string(name) + " " + std::to_string(index) + ", vertex", vertex,
           vertices_.size());
    }
  }

  [[noreturn]] static void fail(std::size_t pair, std::string_view what, std::int32_t index,
                                std::size_t size) {
    throw std::out_of_range("pair " + std::to_string(pair) + ": " + std::string(what) + " " +
                            std::to_string(index) + ", but there are " + std::to_string(size));
  }

  const MovingVertices& vertices_;
  const Candidates& candidates_;
};

}  // namespace

std::array<std::int32_t, moving_points> vertices_of(const Candidates& candidates,
                                                    const IndexPair& pair) {
  const auto [first, second] = pair;
  if (candidates.kind == Kind::vertex_face) {
    const Face& face = at(candidates.faces, second);
    return {first, face[0], face[1], face[2]};
  }
  const Edge& a = at(candidates.edges, first);
  const Edge& b = at(candidates.edges, second);
  return {a[0], a[1], b[0], b[1]};
}

Query query_of(const MovingVertices& vertices, const Candidates& candidates,
               const IndexPair& pair) {
  const auto points = vertices_of(candidates, pair);
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

void require_in_range(const MovingVertices& vertices, const Candidates& candidates) {
  const RangeCheck check(vertices, candidates);
  for (std::size_t pair = 0; pair < candidates.pairs.size(); ++pair) check.require(pair);
}

}  // namespace touchstone::fast

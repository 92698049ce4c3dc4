#include "fast/step/codimensional.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace touchstone::fast::codimensional_test {
namespace {

using Numbers = std::vector<std::int32_t>;

/// A triangle 0 1 2, an edge 3 4, an edge from 5 to itself, points 6 and 2, and an unused vertex 7.
struct Mesh {
  std::vector<Edge> edges{{1, 0}, {0, 2}, {4, 3}, {2, 1}, {5, 5}};
  std::vector<Face> faces{{0, 1, 2}};
  Numbers points{6, 2, 6};

  [[nodiscard]] MeshElements elements() const {
    return {.edges = edges, .faces = faces, .points = points};
  }
};

TEST(VerticesOf, AreThoseOfAllElementsInOrder) {
  const Mesh mesh;
  EXPECT_EQ(vertices_of(8, mesh.elements()), (Numbers{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(vertices_of(3, {}), Numbers{});
}

TEST(Codimensional, PointsHaveNoEdgeAndEdgesNoFace) {
  const Mesh mesh;
  const Numbers vertices = vertices_of(8, mesh.elements());
  const Codimensional parts = codimensional(8, vertices, mesh.elements());
  EXPECT_EQ(parts.points, (Numbers{6}));
  EXPECT_EQ(parts.edges, (Numbers{2, 4}));
}

TEST(Codimensional, EdgesAreNotLookedForWithoutPoints) {
  Mesh mesh;
  mesh.points = {0, 5};
  const Numbers vertices = vertices_of(8, mesh.elements());
  const Codimensional parts = codimensional(8, vertices, mesh.elements());
  EXPECT_EQ(parts.points, Numbers{});
  EXPECT_EQ(parts.edges, Numbers{});
}

}  // namespace
}  // namespace touchstone::fast::codimensional_test

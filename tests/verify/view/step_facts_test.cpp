// What a page says of a step is in tests/transcripts/view.md, of a mesh at rest in
// intersections.md.

#include "verify/view/step_facts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::view::step_facts_test {
namespace {

/// A triangle at rest, two vertices that fall through it at t = 1/4 and t = 1/2, and an edge far
/// away.
mesh::Mesh scene() {
  const std::vector<std::array<double, 3>> coordinates{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 2},
                                                       {1, 2, 1}, {9, 9, 9}, {9, 9, 8}};
  mesh::Mesh result = mesh::make_mesh(coordinates, {{0, 1, 2}}, std::vector<fast::Edge>{{6, 5}});
  result.points = {3, 4};
  return result;
}

mesh::Vertices after(const mesh::Mesh& mesh) {
  mesh::Vertices vertices = mesh.vertices;
  vertices(3, 2) = -2;
  vertices(4, 2) = -3;
  return vertices;
}

/// The points of a pair are those of its query.
TEST(StepFacts, EveryKindOfPairByItsPoints) {
  // Edge 0-1 and point 4 pass down through edge 2-3, and point 6 through point 5.
  const std::vector<std::array<double, 3>> coordinates{
      {-1, 0, 1}, {1, 0, 1}, {0, -1, 0}, {0, 1, 0}, {0, 0.5, 3}, {5, 5, 5}, {5, 5, 6}};
  mesh::Mesh mesh = mesh::make_mesh(coordinates, {}, std::vector<fast::Edge>{{0, 1}, {2, 3}});
  mesh.points = {4, 5, 6};
  mesh::Vertices after = mesh.vertices;
  after(0, 2) = after(1, 2) = -1;
  after(4, 2) = -1;
  after(6, 2) = 4;
  const ViewedStep found = find_collisions("kinds", mesh, mesh.vertices, after, {});
  ASSERT_EQ(found.collisions.size(), 3U);
  for (std::size_t i = 0; i < found.collisions.size(); ++i) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      const Eigen::Index vertex = found.points[i].at(point);
      EXPECT_EQ(found.queries[i].point(0, point), mesh.vertices.row(vertex).transpose()) << i;
      EXPECT_EQ(found.queries[i].point(1, point), after.row(vertex).transpose()) << i;
    }
  }
}

TEST(StepFacts, OfTheStepThatIsTaken) {
  const mesh::Mesh mesh = scene();
  const ViewedStep taken = find_collisions("a step", mesh, mesh.vertices, after(mesh), {}, 0.25);
  ASSERT_EQ(taken.collisions.size(), 1U) << "the other point falls through at t = 1/2";
  EXPECT_EQ(taken.after(4, 2), 0.0);
  EXPECT_EQ(taken.after(3, 2), 1.0);
  EXPECT_EQ(straight_of(first_queries(taken, 1)[0])->at(1, 0, 2), 0.0);
}

TEST(StepFacts, AtASeparation) {
  const mesh::Mesh mesh = scene();
  const ViewedStep near = find_collisions("a step", mesh, mesh.vertices, mesh.vertices,
                                          {.separation = {.distance = 1.0, .norm = Norm::l2}});
  ASSERT_EQ(near.collisions.size(), 1U) << "one point is 1 above the triangle, the other 2";
  EXPECT_EQ(near.points[0], (std::array<std::int32_t, 4>{4, 0, 1, 2}));
  EXPECT_EQ(first_queries(near, 1)[0].separation.distance, 1.0);
}

}  // namespace
}  // namespace touchstone::verify::view::step_facts_test

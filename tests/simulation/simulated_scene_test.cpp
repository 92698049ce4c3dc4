#include "examples/simulation/simulated_scene.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <string>

#include "examples/simulation/world.hpp"

namespace touchstone::simulation::simulated_scene_test {
namespace {

class Scenes : public testing::TestWithParam<SceneDescription> {};

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scenes()), [](const auto& of) {
  std::string name(of.param.name);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(Scenes, BeginWithoutContact) {
  const World world(GetParam().make());
  EXPECT_TRUE(world.step(world.start(), world.start()).is_free());
  EXPECT_TRUE(world.step(world.start(), world.start()).starts_free());
}

TEST_P(Scenes, HaveNoFlatElements) {
  for (const Body& body : GetParam().make().bodies) {
    for (const Tetrahedron& tetrahedron : body.tetrahedra) {
      Eigen::Matrix3d edges;
      for (std::size_t k = 0; k < 3; ++k) {
        edges.col(static_cast<Eigen::Index>(k)) =
            (body.vertices.row(tetrahedron[k + 1]) - body.vertices.row(tetrahedron[0])).transpose();
      }
      const double longest = edges.colwise().norm().maxCoeff();
      EXPECT_GT(std::abs(edges.determinant()), 5e-4 * longest * longest * longest);
    }
  }
}

TEST_P(Scenes, HaveClosedSurfacesAroundElasticBodies) {
  for (const Body& body : GetParam().make().bodies) {
    if (body.kind != BodyKind::elastic) continue;
    // Each edge has two faces.
    std::map<std::array<std::int32_t, 2>, int> passed;
    for (const fast::Face& face : body.faces) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = face[i], b = face[(i + 1) % 3];
        passed[{std::min(a, b), std::max(a, b)}] += 1;
      }
    }
    for (const auto& [edge, times] : passed) EXPECT_EQ(times, 2);
  }
}

}  // namespace
}  // namespace touchstone::simulation::simulated_scene_test

#include "touchstone/touchstone.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/certified.hpp"
#include "tests/support/random.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::adapters::touchstone_test {
namespace {

using tests::Random;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Queries of small integers, among which all sorts of contact occur.
std::vector<Query> random_queries(std::size_t count) {
  Random random(77);
  std::vector<Query> queries(count);
  for (Query& query : queries) {
    for (double& x : query.coordinates) x = random.between(-3, 3);
  }
  return queries;
}

TEST(CInterface, SolvesAsTheSolver) {
  std::vector<Query> queries = random_queries(2000);
  queries[7].coordinates[3] = nan;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    TouchstoneOptions options = touchstone_default_options();
    options.min_separation = 0.25;
    options.norm = TOUCHSTONE_L2;
    options.t_max = 0.75;
    std::vector<TouchstoneImpact> impacts(queries.size());
    ASSERT_EQ(
        touchstone_solve(kind == Kind::vertex_face ? TOUCHSTONE_VERTEX_FACE : TOUCHSTONE_EDGE_EDGE,
                         queries.size(), queries[0].coordinates.data(), &options, impacts.data()),
        0)
        << touchstone_last_error();
    std::size_t colliding = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const fast::CertifiedResult expected = fast::solve(
          kind, queries[i], {.t_max = 0.75, .separation = {.distance = 0.25, .norm = Norm::l2}});
      ASSERT_EQ(impacts[i].verdict, static_cast<std::int32_t>(expected.verdict)) << i;
      if (expected.verdict != fast::Verdict::yes) {
        EXPECT_TRUE(std::isnan(impacts[i].toi_lower));
        continue;
      }
      ++colliding;
      EXPECT_EQ(impacts[i].toi_lower, expected.toi_lower);
      EXPECT_EQ(impacts[i].toi_upper, expected.toi_upper);
      EXPECT_EQ(impacts[i].u, expected.u);
      EXPECT_EQ(impacts[i].v, expected.v);
    }
    EXPECT_GT(colliding, 100U);
    EXPECT_EQ(impacts[7].verdict, TOUCHSTONE_ERROR);
  }
}

/// A triangle that falls through another, beside a point that rests below it and an edge.
struct Scene {
  std::array<double, 27> before{0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                                1, 1, 1, 3, 1, 1, 1, 3, 1, 1, 1, -1, 0, 1, -0.5, 4, 1, -0.5};
  std::array<double, 27> after{0, 0, 0,  4, 0, 0,  0, 4, 0,  //
                               1, 1, -2, 3, 1, -2, 1, 3, -2, 1, 1, 0.5, 0, 1, -0.5, 4, 1, -0.5};
  std::array<std::int32_t, 6> faces{0, 1, 2, 3, 4, 5};
  std::array<std::int32_t, 1> points{6};

  [[nodiscard]] TouchstoneMesh mesh() const {
    TouchstoneMesh mesh{};
    mesh.vertices = 9;
    mesh.before = before.data();
    mesh.after = after.data();
    mesh.faces = 2;
    mesh.face_vertices = faces.data();
    mesh.points = 1;
    mesh.point_vertices = points.data();
    return mesh;
  }
};

TEST(CInterface, DecidesAStep) {
  const Scene scene;
  const TouchstoneMesh mesh = scene.mesh();
  TouchstoneStep* const step = touchstone_step_new(&mesh, nullptr);
  ASSERT_NE(step, nullptr) << touchstone_last_error();
  std::int32_t is_free = -1;
  EXPECT_EQ(touchstone_step_is_free(step, &is_free), 0);
  EXPECT_EQ(is_free, 0);
  TouchstoneImpact earliest{};
  EXPECT_EQ(touchstone_step_earliest(step, &earliest), 0);
  EXPECT_EQ(earliest.verdict, TOUCHSTONE_YES);
  EXPECT_LT(earliest.toi_lower, 1.0 / 3.0);
  EXPECT_GE(earliest.toi_upper, 1.0 / 3.0);
  const TouchstoneCollision* collisions = nullptr;
  std::size_t count = 0;
  ASSERT_EQ(touchstone_step_collisions(step, &collisions, &count), 0);
  bool has_point = false;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_GT(collisions[i].toi_lower, 0.0);
    has_point =
        has_point || (collisions[i].kind == TOUCHSTONE_VERTEX_FACE && collisions[i].first == 6);
  }
  EXPECT_TRUE(has_point) << "the point meets both triangles";
  double alpha = 0.0;
  EXPECT_EQ(touchstone_step_free_step_size(step, &alpha), 0);
  EXPECT_GT(alpha, 0.33);
  EXPECT_LT(alpha, 1.0 / 3.0);
  touchstone_step_free(step);
  touchstone_step_free(nullptr);
}

TEST(CInterface, LeavesOutGroupsThatDoNotMeet) {
  const Scene scene;
  TouchstoneMesh mesh = scene.mesh();
  const std::array<std::int32_t, 9> groups{0, 0, 0, 1, 1, 1, 0, 0, 0};
  const std::array<std::int32_t, 4> apart{0, 1, 0, 0};
  mesh.groups = groups.data();
  mesh.apart = 2;
  mesh.apart_groups = apart.data();
  TouchstoneStep* const step = touchstone_step_new(&mesh, nullptr);
  ASSERT_NE(step, nullptr) << touchstone_last_error();
  std::int32_t is_free = 0;
  EXPECT_EQ(touchstone_step_is_free(step, &is_free), 0);
  EXPECT_EQ(is_free, 1);
  TouchstoneImpact earliest{};
  EXPECT_EQ(touchstone_step_earliest(step, &earliest), 0);
  EXPECT_EQ(earliest.verdict, TOUCHSTONE_NO);
  EXPECT_TRUE(std::isnan(earliest.toi_lower));
  touchstone_step_free(step);
}

void expect_error(const std::string& part) {
  EXPECT_NE(std::string(touchstone_last_error()).find(part), std::string::npos)
      << touchstone_last_error();
}

TEST(CInterface, SaysWhatIsWrong) {
  const std::vector<Query> queries = random_queries(1);
  const double* const coordinates = queries[0].coordinates.data();
  TouchstoneImpact impact{};
  EXPECT_EQ(touchstone_solve(2, 1, coordinates, nullptr, &impact), 2);
  expect_error("kind");
  EXPECT_EQ(touchstone_solve(0, 1, nullptr, nullptr, &impact), 2);
  expect_error("coordinates is null");
  EXPECT_EQ(touchstone_solve(0, 1, coordinates, nullptr, nullptr), 2);
  expect_error("impacts is null");
  EXPECT_EQ(touchstone_solve(0, 0, nullptr, nullptr, nullptr), 0);
  TouchstoneOptions options = touchstone_default_options();
  options.norm = 5;
  EXPECT_EQ(touchstone_solve(0, 1, coordinates, &options, &impact), 2);
  expect_error("norm");
  options = touchstone_default_options();
  options.t_max = 2.0;
  EXPECT_EQ(touchstone_solve(0, 1, coordinates, &options, &impact), 2);
  options = touchstone_default_options();
  options.min_separation = -1.0;
  EXPECT_EQ(touchstone_solve(0, 1, coordinates, &options, &impact), 2);
  EXPECT_EQ(impact.verdict, 0) << "nothing is written";

  EXPECT_EQ(touchstone_step_new(nullptr, nullptr), nullptr);
  expect_error("mesh is null");
  Scene scene;
  scene.faces[2] = 9;
  TouchstoneMesh mesh = scene.mesh();
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr), nullptr);
  expect_error("face 0");
  scene = {};
  scene.after[4] = nan;
  mesh = scene.mesh();
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr), nullptr);
  expect_error("vertex 1");
  mesh.before = nullptr;
  EXPECT_EQ(touchstone_step_new(&mesh, nullptr), nullptr);
  expect_error("before is null");
}

/// A null step or a null output: the other outputs stay as they were.
TEST(CInterface, WritesNothingWithAnError) {
  const Scene scene;
  const TouchstoneMesh mesh = scene.mesh();
  TouchstoneStep* const step = touchstone_step_new(&mesh, nullptr);
  ASSERT_NE(step, nullptr) << touchstone_last_error();
  const TouchstoneCollision* collisions = nullptr;
  std::size_t count = 0;
  ASSERT_EQ(touchstone_step_collisions(step, &collisions, &count), 0);
  const TouchstoneCollision first = collisions[0];

  const TouchstoneCollision untouched{};
  const TouchstoneCollision* written = &untouched;
  std::size_t number = 77;
  EXPECT_EQ(touchstone_step_collisions(step, &written, nullptr), 2);
  expect_error("count is null");
  EXPECT_EQ(touchstone_step_collisions(step, nullptr, &number), 2);
  expect_error("collisions is null");
  EXPECT_EQ(touchstone_step_collisions(nullptr, &written, &number), 2);
  expect_error("step is null");
  EXPECT_EQ(written, &untouched);
  EXPECT_EQ(number, 77U);
  EXPECT_EQ(collisions[0].toi_lower, first.toi_lower) << "what was handed out is valid still";

  std::int32_t is_free = 77;
  EXPECT_EQ(touchstone_step_is_free(nullptr, &is_free), 2);
  EXPECT_EQ(touchstone_step_is_free(step, nullptr), 2);
  EXPECT_EQ(is_free, 77);
  TouchstoneImpact impact{};
  impact.verdict = 77;
  EXPECT_EQ(touchstone_step_earliest(nullptr, &impact), 2);
  EXPECT_EQ(touchstone_step_earliest(step, nullptr), 2);
  EXPECT_EQ(impact.verdict, 77);
  double alpha = 77.0;
  EXPECT_EQ(touchstone_step_free_step_size(nullptr, &alpha), 2);
  EXPECT_EQ(touchstone_step_free_step_size(step, nullptr), 2);
  EXPECT_EQ(alpha, 77.0);
  touchstone_step_free(step);
}

TEST(CInterface, KeepsTheErrorsOfThreadsApart) {
  EXPECT_EQ(touchstone_step_new(nullptr, nullptr), nullptr);
  std::thread([] { EXPECT_STREQ(touchstone_last_error(), ""); }).join();
  expect_error("mesh is null");
  EXPECT_STREQ(touchstone_version(), "0.2.0");
}

}  // namespace
}  // namespace touchstone::adapters::touchstone_test

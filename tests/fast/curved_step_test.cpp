#include "touchstone/step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::fast::curved_step_test {
namespace {

using tests::NumberedPair;
using tests::Random;

/// Some triangles, a bare edge and some points, all moving on curves.
struct Scene {
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;
  tests::Scene mesh;  ///< its places count nothing

  [[nodiscard]] CurvedVertices vertices() const { return {degree, is_rational, numbers}; }

  [[nodiscard]] CurvedQuery query(const std::vector<std::int32_t>& vertices) const {
    const std::size_t stride = is_rational ? 4 : 3, size = (degree + 1) * stride;
    CurvedQuery query;
    for (std::size_t point = 0; point < moving_points; ++point) {
      const double* x = numbers.data() + static_cast<std::size_t>(vertices[point]) * size;
      for (std::size_t k = 0; k <= degree; ++k, x += stride) {
        query.at(point).control.push_back({x[0], x[1], x[2]});
        if (is_rational) query.at(point).weights.push_back(x[3]);
      }
    }
    return query;
  }
};

Scene random_scene(Random& random, std::size_t degree, bool is_rational) {
  const int triangles = 6, vertices = 3 * triangles + 4;
  const tests::Places none = tests::Places::Zero(vertices, 3);
  Scene scene{degree, is_rational, {}, {.start = none, .end = none}};
  for (int vertex = 0; vertex < vertices; ++vertex) {
    const int body = vertex / 3;
    for (std::size_t k = 0; k <= degree; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const double place = axis == 0 ? body % 3 : axis == 1 ? body / 3 : 0;
        scene.numbers.push_back(place + 0.9 * random.uniform(-1, 1));
      }
      if (is_rational) scene.numbers.push_back(k == 1 ? 2.0 : 1.0);
    }
  }
  for (int i = 0; i < triangles; ++i) scene.mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  scene.mesh.edges = edges_of(scene.mesh.faces);
  scene.mesh.edges.push_back({3 * triangles, 3 * triangles + 1});
  scene.mesh.points = {3 * triangles + 2, 3 * triangles + 3};
  return scene;
}

TEST(CurvedStep, HasTheCollisionsOfAllPairs) {
  Random random(97);
  int free = 0, collide = 0;
  for (int round = 0; round < 24; ++round) {
    const Scene scene =
        random_scene(random, 1 + static_cast<std::size_t>(round) % 3, round % 4 == 1);
    const Separation separation =
        round % 2 == 0 ? Separation{} : Separation{.distance = 0.05, .norm = Norm::l2};
    std::set<NumberedPair> found, expected;
    std::optional<std::pair<exact::AlgebraicNumber, NumberedPair>> first;
    const tests::AllPairs all(scene.mesh);
    for (const NumberedPair& pair : all.pairs()) {
      const exact::Decision truth =
          exact::decide(Step::kind_of(pair.first), scene.query(all.vertices(pair)), separation);
      if (!truth.toi) continue;
      expected.insert(pair);
      if (!first || *truth.toi < first->first) first = {*truth.toi, pair};
    }
    const CurvedStep step(scene.vertices(), scene.mesh.elements(),
                          {.separation = separation, .max_threads = 1 + round % 2});
    for (const StepCollision& one : step.collisions()) found.insert({one.kind, one.pair});
    EXPECT_EQ(found, expected) << round;
    EXPECT_EQ(step.is_free(), expected.empty());
    const auto earliest = step.earliest();
    ASSERT_EQ(earliest.has_value(), !expected.empty());
    ++(earliest ? collide : free);
    if (!earliest) continue;
    EXPECT_GE(exact::Rational(earliest->toi_upper), first->first);
    EXPECT_LE(exact::Rational(earliest->toi_lower), first->first);
    EXPECT_TRUE(std::ranges::any_of(earliest->pairs, [&](const StepCollision& one) {
      return NumberedPair(one.kind, one.pair) == first->second;
    }));
  }
  EXPECT_GT(collide, 5);
  EXPECT_GT(free, 1);
}

TEST(CurvedStep, CountsNoLaterContacts) {
  // A vertex falls to a face at rest, at t = 1/2.
  const std::vector<double> numbers{1, 1, 1, 1, 1, 0, 1, 1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                    4, 0, 0, 4, 0, 0, 4, 0, 0,  0, 4, 0, 0, 4, 0, 0, 4, 0};
  const std::vector<Face> faces{{1, 2, 3}};
  const std::vector<std::int32_t> points{0};
  const CurvedVertices vertices{2, false, numbers};
  const MeshElements elements{.faces = faces, .points = points};
  EXPECT_FALSE(CurvedStep(vertices, elements, {.t_max = 0.5}).is_free());
  EXPECT_TRUE(CurvedStep(vertices, elements, {.t_max = 0.499}).is_free());
  EXPECT_EQ(CurvedStep(vertices, elements).earliest()->pairs.size(), 1U);
  // A step keeps its vertices, also where it is moved.
  std::vector<double> others = numbers;
  CurvedStep step({2, false, others}, elements);
  others.assign(others.size(), 7.0);
  const CurvedStep moved = std::move(step);
  EXPECT_EQ(moved.earliest(), CurvedStep(vertices, elements).earliest());
}

TEST(CurvedStep, RefusesWhatIsNoMotion) {
  std::vector<double> numbers(2 * 4 * 2, 1.0);
  const std::vector<std::int32_t> points{0, 1};
  const MeshElements elements{.points = points};
  EXPECT_NO_THROW(CurvedStep({1, true, numbers}, elements));
  EXPECT_THROW(CurvedStep({2, true, numbers}, elements), std::invalid_argument);
  EXPECT_THROW(CurvedStep({9, false, {}}, {}), std::invalid_argument);
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    numbers[11] = bad;
    EXPECT_THROW(CurvedStep({1, true, numbers}, elements), std::domain_error);
  }
}

}  // namespace
}  // namespace touchstone::fast::curved_step_test

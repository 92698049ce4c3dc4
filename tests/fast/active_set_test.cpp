#include "touchstone/active_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "tests/faults/planted_faults.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::fast::active_set_test {
namespace {

using Eigen::Vector3d;
using tests::Places;
using tests::Random;
using tests::Scene;

Scene scene_of(const Places& start, const Places& end) { return {.start = start, .end = end}; }

/// A point that falls from height 1 to −1 over (1,1) of a face in the plane z=0.
Scene falling_point() {
  Places start(4, 3), end(4, 3);
  start << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1;
  end = start;
  end(3, 2) = -1;
  Scene scene = scene_of(start, end);
  scene.faces = {{0, 1, 2}};
  scene.edges = edges_of(scene.faces);
  scene.points = {3};
  return scene;
}

TEST(ActiveSet, HasTheNormalOfTheSideThatAPrimitiveComesFrom) {
  for (const double eta : {0.0, 0.25}) {
    const auto expect_normal = [eta](const Scene& scene, const Vector3d& normal) {
      const auto contacts = active_set(scene.step(), {.distance = eta, .norm = Norm::l2});
      ASSERT_EQ(contacts.size(), 1U);
      EXPECT_EQ(contacts[0].normal, normal);
    };
    Scene scene = falling_point();
    expect_normal(scene, Vector3d(0, 0, 1));
    // A vertex from below, and one above the reversed face.
    std::swap(scene.start, scene.end);
    expect_normal(scene, Vector3d(0, 0, -1));
    scene.faces = {{0, 2, 1}};
    expect_normal(scene, Vector3d(0, 0, -1));
  }
}

/// Two edges without a face, the second at rest.
Scene edges(const Places& start, const Vector3d& motion) {
  Scene scene = scene_of(start, start);
  scene.edges = {{0, 1}, {2, 3}};
  scene.end.topRows(2).rowwise() += motion.transpose();
  return scene;
}

TEST(ActiveSet, HasTheCrossProductOfEdgesForNormal) {
  Places start(4, 3);
  start << -1, 0, 1, 1, 0, 1, 0, -1, 0, 0, 1, 0;
  for (const double eta : {0.0, 0.25}) {
    const auto contacts =
        active_set(edges(start, {0, 0, -2}).step(), {.distance = eta, .norm = Norm::l2});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].normal, Vector3d(0, 0, 1));
    EXPECT_NEAR((contacts[0].first - contacts[0].second).norm(), eta, 1e-10);
  }
}

TEST(ActiveSet, HasADefinedNormalForParallelEdges) {
  Places start(4, 3);
  start << -1, 0, 1, 1, 0, 1, -1, 0, 0, 1, 0, 0;
  const auto normal = [&](const Places& at, const Vector3d& motion, double eta) {
    const auto contacts = active_set(edges(at, motion).step(), {.distance = eta, .norm = Norm::l2});
    EXPECT_EQ(contacts.size(), 1U);
    return contacts.at(0).normal;
  };
  const double root = std::sqrt(0.5);
  EXPECT_TRUE(normal(start, {0, 0, -2}, 0.25).isApprox(Vector3d(0, 0, 1)));
  // Edges in contact: the normal is against the motion, upright on the edge.
  EXPECT_TRUE(normal(start, {0.5, 0, -2}, 0.0).isApprox(Vector3d(0, 0, 1)));
  start.topRows(2).col(1).array() += 1.0;
  EXPECT_TRUE(normal(start, {0.5, -2, -2}, 0.0).isApprox(Vector3d(0, root, root)));
  // Edges always in contact: the normal is upright on the edge.
  start.topRows(2) = start.bottomRows(2);
  const Vector3d any = normal(start, {0, 0, 0}, 0.0);
  EXPECT_NEAR(any.norm(), 1.0, 1e-15);
  EXPECT_EQ(any.x(), 0.0);
  EXPECT_EQ(normal(start, {0.5, 0, 0}, 0.0), any);
}

TEST(ActiveSet, HasTheDirectionOfNearestPointsForCodimensionalPairs) {
  Places start(4, 3), end(4, 3);
  start << 0, 0, 0, 4, 0, 0, 1, 3, 4, 2, 3, 4;
  end = start;
  end.row(2) << 1, -3, -4;
  Scene scene = scene_of(start, end);
  scene.edges = {{0, 1}};
  scene.points = {2};
  for (const double eta : {0.0, 1.0}) {
    const auto contacts = active_set(scene.step(), {.distance = eta, .norm = Norm::l2});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].kind, PairKind::vertex_edge);
    EXPECT_TRUE(contacts[0].normal.isApprox(Vector3d(0, 0.6, 0.8)));
    EXPECT_NEAR(contacts[0].u, 0.25, 1e-10);
  }
  scene.edges.clear();
  scene.points = {0, 2};
  scene.end.row(2) << -1, -3, -4;
  for (const double eta : {0.0, 1.0}) {
    const auto contacts = active_set(scene.step(), {.distance = eta, .norm = Norm::l2});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].kind, PairKind::vertex_vertex);
    EXPECT_TRUE(contacts[0].normal.isApprox(Vector3d(-1, -3, -4).normalized()));
  }
}

TEST(ActiveSet, IsTheCollisionsAtThatSeparationInOrder) {
  Random random(2200);
  std::size_t found = 0;
  for (int round = 0; round < tests::trials(30); ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      const Scene scene = tests::random_scene(random, shape, random.between(2, 10));
      const Norm norm = random.coin() ? Norm::l2 : Norm::linf;
      const double eta = random.coin() ? shape.separation : 0.0;
      // The separation of the step does not matter.
      const auto contacts =
          active_set(scene.step({.separation = {.distance = 3 * shape.separation}}),
                     {.distance = eta, .norm = norm});
      auto collisions = scene.step({.separation = {.distance = eta, .norm = norm}}).collisions();
      std::ranges::sort(collisions, {}, [](const StepCollision& one) {
        return std::tuple(one.toi_lower, one.toi_upper, one.kind, one.pair);
      });
      ASSERT_EQ(contacts.size(), collisions.size());
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const ActiveContact& one = contacts[i];
        EXPECT_EQ((StepCollision{one.kind, one.pair, one.toi_lower, one.toi_upper, one.u, one.v}),
                  collisions[i]);
        EXPECT_NEAR(one.normal.norm(), 1.0, 1e-14) << shape.name;
      }
      found += contacts.size();
    }
  }
  EXPECT_GT(found, tests::trials(80U));
}

TEST(ActiveSet, NormalsPointFromTheSecondPrimitiveToTheFirst) {
  Random random(2201);
  constexpr double eta = 0.05;
  int seen = 0;
  for (int round = 0; round < tests::trials(20); ++round) {
    const Scene scene = tests::soup(random, 30, 0.2);
    for (const ActiveContact& one : active_set(scene.step(), {.distance = eta, .norm = Norm::l2})) {
      const Vector3d between = one.first - one.second;
      if (one.toi_lower == 0.0) continue;
      EXPECT_NEAR(between.norm(), eta, 1e-9);
      EXPECT_GT(one.normal.dot(between), -1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, tests::trials(100));
}

TEST(ActiveSet, NormalsAreTheSameAtAllScales) {
  Random random(2203);
  for (int round = 0; round < tests::trials(8); ++round) {
    const Scene scene = tests::soup(random, 30, 0.2);
    std::map<std::pair<PairKind, IndexPair>, Vector3d> expected;
    for (const ActiveContact& one :
         active_set(scene.step(), {.distance = 0.05, .norm = Norm::l2})) {
      expected[{one.kind, one.pair}] = one.normal;
    }
    for (const int exponent : {-1000, -600, 300, 1000}) {
      Scene scaled = scene;
      for (Places* const places : {&scaled.start, &scaled.end}) {
        *places = places->unaryExpr([&](double x) { return std::ldexp(x, exponent); });
      }
      const auto contacts =
          active_set(scaled.step(), {.distance = std::ldexp(0.05, exponent), .norm = Norm::l2});
      EXPECT_EQ(contacts.size(), expected.size());
      for (const ActiveContact& one : contacts) {
        const Vector3d normal = expected.at({one.kind, one.pair});
        EXPECT_TRUE(one.normal.isApprox(normal, 1e-9)) << exponent;
      }
    }
  }
}

TEST(ActiveSet, ContactsAtTheirTimesAreThose) {
  Random random(2202);
  constexpr double eta = 0.05;
  std::size_t seen = 0;
  for (int round = 0; round < tests::trials(20); ++round) {
    const Scene scene = tests::soup(random, 30, 0.2);
    const Step step = scene.step();
    for (const ActiveContact& one : active_set(step, {.distance = eta, .norm = Norm::l2})) {
      const ActiveContact again = contact_at(step, one.kind, one.pair, one.toi_upper);
      EXPECT_EQ(again.toi_lower, one.toi_upper);
      EXPECT_EQ(again.toi_upper, one.toi_upper);
      // The nearest points need not be unique; their distance is.
      EXPECT_NEAR((again.first - again.second).norm(), (one.first - one.second).norm(), 1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, tests::trials(100U));
}

TEST(ActiveSet, ContactOfAPairThatIsNotNear) {
  const Scene scene = falling_point();
  const Step step = scene.step();
  const ActiveContact at_start = contact_at(step, PairKind::vertex_face, {3, 0}, 0.0);
  EXPECT_TRUE(at_start.first.isApprox(Vector3d(1, 1, 1)));
  EXPECT_TRUE(at_start.second.isApprox(Vector3d(1, 1, 0)));
  EXPECT_EQ(at_start.normal, Vector3d(0, 0, 1));
  EXPECT_EQ(contact_at(step, PairKind::vertex_face, {3, 0}, 1.0).normal, Vector3d(0, 0, -1));
}

/// Two vertices of a face part at t=0: just after that, the face has an area and a normal.
TEST(ActiveSet, HasTheNormalOfAFaceAtTheLeastTime) {
  Scene scene = falling_point();
  scene.start.row(1) = scene.start.row(0);
  scene.end.row(1) << 3, 0, 4;
  for (const double t : {0x1p-1074, 0x1p-1000, 0x1p-20, 1.0}) {
    const Vector3d normal = contact_at(scene.step(), PairKind::vertex_face, {3, 0}, t).normal;
    EXPECT_TRUE(normal.cwiseAbs().isApprox(Vector3d(0.8, 0, 0.6))) << t;
  }
}

TEST(ActiveSet, PlantedFaultsAreFound) {
  const Scene scene = falling_point();
  const Step step = scene.step();
  for (const auto& fault : tests::planted_faults().active_set) {
    EXPECT_NE(fault.part(step, {}), active_set(step, {})) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::active_set_test

#include "touchstone/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

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

// ---- By hand ------------------------------------------------------------------------------------

/// Four vertices: the first `moving` of them move by this.
Scene four_vertices(const std::array<double, 12>& start, int moving, const Vector3d& motion) {
  Scene scene{.start = Eigen::Map<const Eigen::Matrix<double, 4, 3, Eigen::RowMajor>>(start.data()),
              .end = {}};
  scene.end = scene.start;
  scene.end.topRows(moving).rowwise() += motion.transpose();
  return scene;
}

/// A point that moves over (1,1) of a face in the plane z=0.
Scene point_and_face(double start, double motion, const Face& face = {1, 2, 3}) {
  Scene scene = four_vertices({1, 1, start, 0, 0, 0, 4, 0, 0, 0, 4, 0}, 1, {0, 0, motion});
  scene.faces = {face};
  scene.edges = edges_of(scene.faces);
  scene.points = {0};
  return scene;
}

/// Two edges without a face, the second at rest.
Scene two_edges(const std::array<double, 12>& start, const Vector3d& motion) {
  Scene scene = four_vertices(start, 2, motion);
  scene.edges = {{0, 1}, {2, 3}};
  return scene;
}

/// A point that falls onto an edge or one of its ends.
Scene falling_point(const Vector3d& motion, const std::vector<Edge>& edges) {
  Scene scene = four_vertices({1, 3, 4, 0, 0, 0, 4, 0, 0, 9, 9, 9}, 1, motion);
  scene.edges = edges;
  scene.points = {0, 1};
  return scene;
}

TEST(ActiveSet, HasTheNormalOfTheSideThatAPrimitiveComesFrom) {
  constexpr std::array<double, 12> crossed{-1, 0, 1, 1, 0, 1, 0, -1, 0, 0, 1, 0},
      parallel{-1, 0, 1, 1, 0, 1, -1, 0, 0, 1, 0, 0}, beside{-1, 1, 1, 1, 1, 1, -1, 0, 0, 1, 0, 0};
  const double root = std::sqrt(0.5);
  struct Row {
    Scene scene;
    PairKind kind;
    std::vector<double> distances;
    Vector3d normal;
  };
  for (const auto& [scene, kind, distances, normal] :
       {Row{point_and_face(1, -2), PairKind::vertex_face, {0.0, 0.25}, {0, 0, 1}},
        Row{point_and_face(-1, 2), PairKind::vertex_face, {0.0, 0.25}, {0, 0, -1}},
        Row{point_and_face(-1, 2, {1, 3, 2}), PairKind::vertex_face, {0.0, 0.25}, {0, 0, -1}},
        Row{two_edges(crossed, {0, 0, -2}), PairKind::edge_edge, {0.0, 0.25}, {0, 0, 1}},
        Row{two_edges(parallel, {0, 0, -2}), PairKind::edge_edge, {0.25}, {0, 0, 1}},
        // Parallel edges in contact: the normal is against the motion, upright on the edge.
        Row{two_edges(parallel, {0.5, 0, -2}), PairKind::edge_edge, {0.0}, {0, 0, 1}},
        Row{two_edges(beside, {0.5, -2, -2}), PairKind::edge_edge, {0.0}, {0, root, root}},
        // The direction of the nearest points.
        Row{falling_point({0, -6, -8}, {{1, 2}}), PairKind::vertex_edge, {0.0, 1.0}, {0, 0.6, 0.8}},
        Row{falling_point({-2, -6, -8}, {}),
            PairKind::vertex_vertex,
            {0.0, 1.0},
            Vector3d(1, 3, 4).normalized()}}) {
    for (const double distance : distances) {
      const auto contacts = active_set(scene.step(), {.distance = distance, .norm = Norm::l2});
      ASSERT_EQ(contacts.size(), 1U);
      EXPECT_EQ(contacts[0].kind, kind);
      EXPECT_TRUE(contacts[0].normal.isApprox(normal)) << contacts[0].normal;
      EXPECT_NEAR((contacts[0].first - contacts[0].second).norm(), distance, 1e-10);
    }
  }
}

TEST(ActiveSet, HasADefinedNormalForEdgesThatAreAlwaysInContact) {
  static constexpr std::array<double, 12> same{-1, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0};
  const auto normal = [](const Vector3d& motion) {
    return active_set(two_edges(same, motion).step(), {}).at(0).normal;
  };
  const Vector3d any = normal({0, 0, 0});
  EXPECT_NEAR(any.norm(), 1.0, 1e-15);
  EXPECT_EQ(any.x(), 0.0);
  EXPECT_EQ(normal({0.5, 0, 0}), any);
}

TEST(ActiveSet, ContactOfAPairThatIsNotNear) {
  const Scene scene = point_and_face(1, -2);
  const Step step = scene.step();
  const ActiveContact at_start = contact_at(step, PairKind::vertex_face, {0, 0}, 0.0);
  EXPECT_TRUE(at_start.first.isApprox(Vector3d(1, 1, 1)));
  EXPECT_TRUE(at_start.second.isApprox(Vector3d(1, 1, 0)));
  EXPECT_EQ(at_start.normal, Vector3d(0, 0, 1));
  EXPECT_EQ(contact_at(step, PairKind::vertex_face, {0, 0}, 1.0).normal, Vector3d(0, 0, -1));
}

/// Two vertices of a face part at t=0: just after that, the face has an area and a normal.
TEST(ActiveSet, HasTheNormalOfAFaceAtTheLeastTime) {
  Scene scene = point_and_face(1, -2);
  scene.start.row(2) = scene.start.row(1);
  scene.end.row(2) << 3, 0, 4;
  for (const double t : {0x1p-1074, 0x1p-1000, 0x1p-20, 1.0}) {
    const Vector3d normal = contact_at(scene.step(), PairKind::vertex_face, {0, 0}, t).normal;
    EXPECT_TRUE(normal.cwiseAbs().isApprox(Vector3d(0.8, 0, 0.6))) << t;
  }
}

// ---- In random scenes ---------------------------------------------------------------------------

TEST(ActiveSet, IsTheCollisionsAtThatSeparationInOrder) {
  Random random(2200);
  std::size_t found = 0;
  for (int round = 0; round < tests::trials(30); ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      Scene scene = tests::random_scene(random, shape, random.between(2, 10));
      if (round % 5 == 4) {
        tests::add_thickness(scene, std::min(shape.separation, 1e300), random);
      }
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

Scene scaled(Scene scene, int exponent) {
  for (Places* const places : {&scene.start, &scene.end}) {
    *places = places->unaryExpr([&](double x) { return std::ldexp(x, exponent); });
  }
  return scene;
}

/// Normals point from the second primitive to the first, are the same at all scales, and contacts
/// at their times are those.
TEST(ActiveSet, NormalsAndContactsAgreeWithEachOther) {
  Random random(2202);
  constexpr double eta = 0.05;
  std::size_t seen = 0;
  for (int round = 0; round < tests::trials(20); ++round) {
    const Scene scene = tests::soup(random, 30, 0.2);
    const Step step = scene.step();
    std::map<std::pair<PairKind, IndexPair>, Vector3d> normals;
    for (const ActiveContact& one : active_set(step, {.distance = eta, .norm = Norm::l2})) {
      normals[{one.kind, one.pair}] = one.normal;
      const Vector3d between = one.first - one.second;
      const ActiveContact again = contact_at(step, one.kind, one.pair, one.toi_upper);
      EXPECT_EQ(again.toi_lower, one.toi_upper);
      EXPECT_EQ(again.toi_upper, one.toi_upper);
      // The nearest points need not be unique; their distance is.
      EXPECT_NEAR((again.first - again.second).norm(), between.norm(), 1e-9);
      if (one.toi_lower == 0.0) continue;
      EXPECT_NEAR(between.norm(), eta, 1e-9);
      EXPECT_GT(one.normal.dot(between), -1e-9);
      ++seen;
    }
    if (round >= 8) continue;
    for (const int exponent : {-1000, -600, 300, 1000}) {
      const auto contacts = active_set(scaled(scene, exponent).step(),
                                       {.distance = std::ldexp(eta, exponent), .norm = Norm::l2});
      EXPECT_EQ(contacts.size(), normals.size());
      for (const ActiveContact& one : contacts) {
        EXPECT_TRUE(one.normal.isApprox(normals.at({one.kind, one.pair}), 1e-9)) << exponent;
      }
    }
  }
  EXPECT_GT(seen, tests::trials(100U));
}

/// The active sets of a scene by hand and of random ones with radii differ.
bool is_found(tests::FindActive& find) {
  const Scene by_hand = point_and_face(1, -2);
  const Step falling = by_hand.step();
  if (find(falling, {}) != active_set(falling, {})) return true;
  Random random(2203);
  for (int round = 0; round < 200; ++round) {
    const std::size_t which = static_cast<std::size_t>(random.between(0, 3));
    const tests::Shape shape = tests::shapes()[which];
    Scene scene = round % 4 == 0 ? tests::soup(random, 40, 0.05)
                                 : tests::random_scene(random, shape, random.between(4, 12));
    tests::add_thickness(scene, round % 4 == 0 ? 0.1 : shape.separation, random);
    const Step step = scene.step();
    const Separation separation{.distance = 0.0, .norm = random.coin() ? Norm::l2 : Norm::linf};
    if (find(step, separation) != active_set(step, separation)) return true;
  }
  return false;
}

TEST(ActiveSet, PlantedFaultsAreFound) {
  EXPECT_FALSE(is_found(active_set));
  for (const auto& fault : tests::planted_faults().active_set) {
    EXPECT_TRUE(is_found(*fault.part)) << fault.name;
  }
}

}  // namespace
}  // namespace touchstone::fast::active_set_test

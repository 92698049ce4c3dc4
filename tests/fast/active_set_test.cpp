#include "touchstone/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
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

TEST(ActiveSet, HasThePointsAndTheNormalOfTheSideThatAPrimitiveComesFrom) {
  constexpr std::array<double, 12> crossed{-1, 0, 1, 1, 0, 1, 0, -1, 0, 0, 1, 0},
      parallel{-1, 0, 1, 1, 0, 1, -1, 0, 0, 1, 0, 0},
      slanting{-1, 0.3, 1, 1, 0.9, 1, 1, 0.9, 0, -1, 0.3, 0},
      beside{-1, 1, 1, 1, 1, 1, -1, 0, 0, 1, 0, 0};
  const double root = std::sqrt(0.5);
  const std::optional<Vector3d> many, at_origin(Vector3d::Zero()), in_face({1, 1, 0});
  struct Row {
    Scene scene;
    ContactKind kind;
    std::vector<double> distances;
    Vector3d normal;
    std::optional<Vector3d> second;  ///< the point on the second primitive, if there is only one
    bool has_normal = true;
  };
  for (const auto& [scene, kind, distances, normal, second, has_normal] :
       {Row{point_and_face(1, -2), ContactKind::vertex_face, {0.0, 0.25}, {0, 0, 1}, in_face},
        Row{point_and_face(-1, 2), ContactKind::vertex_face, {0.0, 0.25}, {0, 0, -1}, in_face},
        Row{point_and_face(-1, 2, {1, 3, 2}),
            ContactKind::vertex_face,
            {0.0, 0.25},
            {0, 0, -1},
            in_face},
        Row{two_edges(crossed, {0, 0, -2}),
            ContactKind::edge_edge,
            {0.0, 0.25},
            {0, 0, 1},
            at_origin},
        Row{two_edges(parallel, {0, 0, -2}), ContactKind::edge_edge, {0.25}, {0, 0, 1}, many},
        Row{two_edges(slanting, {0, 0, -2}), ContactKind::edge_edge, {0.25}, {0, 0, 1}, many},
        Row{two_edges(slanting, {0, 0, -2}), ContactKind::edge_edge, {0.0}, {0, 0, 1}, many, false},
        // Parallel edges in contact: the normal is against the motion, upright on the edge.
        Row{two_edges(parallel, {0.5, 0, -2}),
            ContactKind::edge_edge,
            {0.0},
            {0, 0, 1},
            many,
            false},
        Row{two_edges(beside, {0.5, -2, -2}),
            ContactKind::edge_edge,
            {0.0},
            {0, root, root},
            many,
            false},
        // The direction of the nearest points.
        Row{falling_point({0, -6, -8}, {{1, 2}}),
            ContactKind::vertex_edge,
            {0.0, 1.0},
            {0, 0.6, 0.8},
            Vector3d(1, 0, 0)},
        Row{falling_point({-2, -6, -8}, {}),
            ContactKind::vertex_vertex,
            {0.0, 1.0},
            Vector3d(1, 3, 4).normalized(),
            at_origin}}) {
    for (const double distance : distances) {
      const auto contacts = active_set(scene.step(), {.distance = distance, .norm = Norm::l2});
      ASSERT_EQ(contacts.size(), 1U);
      const ActiveContact& one = contacts[0];
      EXPECT_EQ(one.kind, kind);
      EXPECT_TRUE(one.normal.isApprox(normal)) << one.normal;
      EXPECT_NEAR((one.first - one.second).norm(), distance, 1e-10);
      EXPECT_EQ(one.has_normal(), has_normal);
      EXPECT_EQ(one.has_side, has_normal);
      EXPECT_TRUE(!has_normal || (one.normal - normal).norm() <= one.normal_error);
      EXPECT_LT(one.point_error, 1e-10) << to_string(kind);
      if (!second) continue;
      EXPECT_LE((one.second - *second).norm(), one.point_error);
      EXPECT_LE((one.first - *second - distance * normal).norm(), one.point_error + 1e-15);
    }
  }
}

/// A contact without a normal, or with one whose side cannot be told.
TEST(ActiveSet, SaysWhatIsNotProved) {
  constexpr std::array<double, 12> end_to_middle{0, 0, 0, 0, 0, 5, -1, 0, 0, 1, 0, 0},
      overlapping{-1, 0, 0, 1, 0, 0, 0, 0, 0, 3, 0, 0};
  const auto at_corner = [](const Vector3d& motion) {
    Scene scene = point_and_face(0, 0);
    scene.start.row(0) = scene.start.row(2);
    scene.end.row(0) = scene.start.row(0) + motion.transpose();
    return scene;
  };
  Scene flat = point_and_face(1, -2);  // a face whose vertices are on a line
  flat.start.row(0) << 1, 0, 1;
  flat.end.row(0) << 1, 0, -1;
  for (Places* const places : {&flat.start, &flat.end}) places->row(3) << 2, 0, 0;
  Scene along_edge = falling_point({0, 0, 0}, {{1, 2}});
  along_edge.start.row(0) << 1, 0, 0;
  along_edge.end.row(0) << 2, 0, 0;
  // A face that turns, and a point at rest, which is in its plane once: det = −(t − 1/2)²/4.
  Scene grazing = four_vertices({0.25, 0.0625, 0.25, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 0, {0, 0, 0});
  grazing.end.row(2) << 1, 1, 0;
  grazing.end.row(3) << 1, 0, 1;
  grazing.faces = {{1, 2, 3}};
  grazing.edges = edges_of(grazing.faces);
  grazing.points = {0};
  struct Row {
    std::string name;
    Scene scene;
    bool has_normal, has_side;
  };
  for (const auto& [name, scene, has_normal, has_side] :
       {Row{"at rest", point_and_face(0, 0), true, false},
        Row{"through the face", point_and_face(0, -1), true, true},
        Row{"along the face", at_corner({-1, 1, 0}), true, false},
        Row{"at a corner", at_corner({0, 0, -1}), true, true},
        Row{"an end", two_edges(end_to_middle, {0, -1, 0}), true, true},
        Row{"edges on a line", two_edges(overlapping, {0, 0, 1}), false, false},
        Row{"a face without an area", flat, false, false},
        Row{"a point along an edge", along_edge, false, false},
        Row{"grazing", grazing, true, false}}) {
    const auto contacts = active_set(scene.step(), {});
    ASSERT_EQ(contacts.size(), 1U) << name;
    EXPECT_EQ(contacts[0].has_normal(), has_normal) << name;
    EXPECT_EQ(contacts[0].has_side, has_side) << name;
    EXPECT_NEAR(contacts[0].normal.norm(), 1.0, 1e-15) << name;
  }
}

/// In contact at the start, the side is that of the motion continued backwards, also with a
/// separation; a contact that is only near has the side where it is.
TEST(ActiveSet, TellsContactAtTheStartFromADistance) {
  for (const double height : {0.0, 0x1p-1000, 0x1p-60, 0.125}) {
    const auto contacts = active_set(point_and_face(-height, 1).step(), {.distance = 0.25});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_TRUE(contacts[0].has_normal()) << height;
    EXPECT_TRUE(contacts[0].has_side) << height;
    EXPECT_TRUE(contacts[0].normal.isApprox(Vector3d(0, 0, -1))) << height;
  }
}

/// Two vertices of a face part at t=0: just after that, the face has an area and a normal. A point
/// is in it at all times.
TEST(ActiveSet, HasTheNormalOfAFaceAtTheLeastTime) {
  Scene scene = point_and_face(0, 0);
  scene.start.row(2) = scene.start.row(1);
  scene.end.row(2) << 3, 0, 4;
  scene.start.row(0) << 0, 1, 0;
  scene.end.row(0) << 0.75, 1, 1;
  for (const double t : {0x1p-1074, 0x1p-1000, 0x1p-20, 1.0}) {
    const ActiveContact contact = contact_at(scene.step(), ContactKind::vertex_face, {0, 0}, t);
    EXPECT_TRUE(contact.normal.cwiseAbs().isApprox(Vector3d(0.8, 0, 0.6))) << t;
    EXPECT_LT(contact.normal_error, 1e-14) << t;
    EXPECT_FALSE(contact.has_side) << t;
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
          active_set(scene.step({.solve = {.separation = {.distance = 3 * shape.separation}}}),
                     {.distance = eta, .norm = norm});
      auto collisions =
          scene.step({.solve = {.separation = {.distance = eta, .norm = norm}}}).collisions();
      std::ranges::sort(collisions, {}, [](const StepCollision& one) {
        return std::tuple(one.toi_lower, one.toi_upper, one.kind, one.pair);
      });
      ASSERT_EQ(contacts.size(), collisions.size());
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const ActiveContact& one = contacts[i];
        EXPECT_EQ(std::tie(one.kind, one.pair, one.toi_lower, one.toi_upper),
                  std::tie(collisions[i].kind, collisions[i].pair, collisions[i].toi_lower,
                           collisions[i].toi_upper));
        EXPECT_NEAR(one.normal.norm(), 1.0, 1e-14) << shape.name;
        EXPECT_TRUE(one.first.allFinite() && one.second.allFinite()) << shape.name;
        EXPECT_GE(one.point_error, 0.0) << shape.name;
        EXPECT_GT(one.normal_error, 0.0) << shape.name;
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
    std::map<std::pair<ContactKind, IndexPair>, Vector3d> normals;
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

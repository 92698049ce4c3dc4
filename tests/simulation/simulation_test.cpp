/// \file
/// The example's simulators: energies, scenes, collisions, whole runs, and what they record.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/recorder.hpp"
#include "examples/simulation/simulated_scene.hpp"
#include "examples/simulation/simulator.hpp"
#include "examples/simulation/world.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/dataset.hpp"

namespace touchstone::simulation::simulation_test {
namespace {

// ---- Energies -----------------------------------------------------------------------------------

using Eigen::VectorXd;

Scene scene_of(std::vector<Body> bodies) {
  Scene scene;
  scene.bodies = std::move(bodies);
  return scene;
}

Scene small_block() {
  return scene_of({block({2, 1, 1}, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {x.x(), 0.7 * x.y(), 0.4 * x.z()};
  })});
}

VectorXd random_vector(Eigen::Index size, unsigned seed) {
  tests::Random random(seed);
  VectorXd result(size);
  for (double& x : result) x = random.between(-1000, 1000) / 1000.0;
  return result;
}

TEST(World, HasNoEnergyAtRestAndAfterARotation) {
  const World world(small_block());
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  VectorXd turned = world.start();
  for (Eigen::Index i = 0; i < turned.size(); i += 3) {
    turned.segment<3>(i) = (turn * turned.segment<3>(i) + Eigen::Vector3d(1, -2, 0.5)).eval();
  }
  for (const VectorXd& x : {world.start(), turned}) {
    Derivatives derivatives(x.size());
    EXPECT_NEAR(world.energy(x, 0.0, &derivatives), 0.0, 1e-8);
    EXPECT_LT(derivatives.gradient.lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

/// The energy along a line is a polynomial of degree at most 6, and seven values determine its
/// derivatives exactly. At rest no eigenvalue of the Hessian is negative.
TEST(World, HasTheDerivativesOfThePolynomialThatItsEnergyIs) {
  const World world(small_block());
  for (const unsigned seed : {0U, 1U, 2U, 3U}) {
    const bool is_at_rest = seed == 0;
    const VectorXd x =
        world.start() + (is_at_rest ? 0.0 : 0.1) * random_vector(world.coordinates(), seed);
    const VectorXd direction = random_vector(world.coordinates(), 10 + seed);
    constexpr double step = 0.125;
    std::array<double, 7> values{};
    for (int k = -3; k <= 3; ++k) {
      values[static_cast<std::size_t>(k + 3)] = world.energy(x + k * step * direction, 0.0);
    }
    const double slope =
        (45.0 * (values[4] - values[2]) - 9.0 * (values[5] - values[1]) + values[6] - values[0]) /
        (60.0 * step);
    const double curvature = (2.0 * (values[6] + values[0]) - 27.0 * (values[5] + values[1]) +
                              270.0 * (values[4] + values[2]) - 490.0 * values[3]) /
                             (180.0 * step * step);
    Derivatives derivatives(x.size());
    const double energy = world.energy(x, 0.0, &derivatives);
    EXPECT_NEAR(energy, values[3], 1e-12 * energy);
    EXPECT_NEAR(derivatives.gradient.dot(direction), slope, 1e-9 * values[6]);
    Eigen::SparseMatrix<double> hessian(x.size(), x.size());
    hessian.setFromTriplets(derivatives.hessian.begin(), derivatives.hessian.end());
    EXPECT_LT((hessian - Eigen::SparseMatrix<double>(hessian.transpose())).norm(),
              1e-9 * hessian.norm());
    // Omitting negative eigenvalues can only add.
    const double found = direction.dot(hessian * direction);
    EXPECT_GE(found, curvature - 1e-8 * values[6]);
    if (is_at_rest) {
      EXPECT_NEAR(found, curvature, 1e-9 * curvature);
    }
  }
}

TEST(World, PullsPinsWhereTheyAreToBe) {
  Scene scene = small_block();
  scene.pins.push_back({0, [](double t) -> Eigen::Vector3d { return {t, 0.0, 0.0}; }});
  const World world(scene);
  Derivatives derivatives(world.coordinates());
  world.energy(world.start(), 2.0, &derivatives);
  const Eigen::Vector3d away = world.start().head<3>() - Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_LT(derivatives.gradient.head<3>().cross(away).norm(), 1e-6);
  EXPECT_GT(derivatives.gradient.head<3>().dot(away), 0.0);
}

// ---- Scenes -------------------------------------------------------------------------------------

TEST(Scenes, BeginWithoutContact) {
  for (const SceneDescription& scene : scenes()) {
    const World world(scene.make());
    EXPECT_TRUE(world.step(world.start(), world.start()).starts_free()) << scene.name;
  }
}

// ---- Collisions ---------------------------------------------------------------------------------

/// A soft box 5 mm above the tip of a pyramid.
Scene box_over_a_spike() {
  return scene_of({block({4, 4, 4},
                         [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
                           return 0.05 * x + Eigen::Vector3d(0.003, 0.002, 0.055);
                         }),
                   cone({0.0, 0.0, 0.0}, 0.03, -0.2, 4)});
}

/// The positions with what can move this much lower, in metres.
VectorXd lowered(const World& world, double by) {
  VectorXd result = world.start();
  for (Eigen::Index i = 2; i < result.size(); i += 3) {
    if (!world.is_held(i)) result[i] -= by;
  }
  return result;
}

/// This box falls a tenth of a metre.
class FallingBox : public testing::Test {
 protected:
  [[nodiscard]] fast::Step step() const {
    return world_.step(world_.start(), lowered(world_, 0.1));
  }

  World world_{box_over_a_spike()};
};

using Pairs = std::vector<std::pair<ContactKind, fast::IndexPair>>;

Pairs pairs_of(const std::vector<fast::ActiveContact>& contacts) {
  Pairs result;
  for (const fast::ActiveContact& one : contacts) result.emplace_back(one.kind, one.pair);
  std::ranges::sort(result);
  return result;
}

// The box starts 5 mm above the tip: the step is free until t = 0.05.
TEST_F(FallingBox, MayMoveAsFarAsTheTip) {
  for (const char* method : {"certified", "tight_inclusion"}) {
    CollisionDetector detector({.method = method});
    const double found = detector.step_size(step());
    EXPECT_GT(found, 0.0) << method;
    EXPECT_LT(found, 0.05) << method;
    EXPECT_EQ(detector.statistics().calls, 1) << method;
    EXPECT_EQ(detector.statistics().steps_of_zero, 0) << method;
  }
  CollisionDetector certified({.p = 0.25});
  // A quarter of the initial 5 mm stays.
  EXPECT_NEAR(certified.step_size(step()), 0.75 * 0.05, 1e-9);
}

TEST_F(FallingBox, HasTheSameActiveSetPairByPair) {
  CollisionDetector whole({}), by_pairs({.missed_one_in = 1'000'000'000'000});
  CollisionDetector conservative({.method = "tight_inclusion"});
  const auto expected = whole.active_set(step(), 1e-3), found = by_pairs.active_set(step(), 1e-3);
  EXPECT_TRUE(
      std::ranges::includes(pairs_of(conservative.active_set(step(), 1e-3)), pairs_of(expected)));
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(pairs_of(expected), pairs_of(found));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT((found[i].first - expected[i].first).norm(), 1e-6);
    EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-4);
  }
}

TEST_F(FallingBox, FallsThroughIfAllIsMissed) {
  CollisionDetector blind({.missed_one_in = 1});
  EXPECT_EQ(blind.step_size(step()), 1.0);
  EXPECT_TRUE(blind.active_set(step(), 1e-3).empty());
  EXPECT_GT(blind.statistics().missed, 0);
}

TEST_F(FallingBox, IsStoppedByAnotherPairIfOneIsMissedOnce) {
  CollisionDetector all({.missed_one_in = 1'000'000'000'000}), second({.missed_limit = 2});
  const double limit = all.step_size(step());
  EXPECT_EQ(second.step_size(step()), limit);
  // The tip meets an inner vertex of the box's mesh first, or one of many faces around it: another
  // pair is later or at the same time, and none is missed.
  EXPECT_GE(second.step_size(step()), limit);
  EXPECT_EQ(second.statistics().missed, 1);
  EXPECT_EQ(second.step_size(step()), limit);
  EXPECT_EQ(second.statistics().missed, 1);
  EXPECT_EQ(second.statistics().limited, 3);
}

// ---- Simulators ---------------------------------------------------------------------------------

/// The result of a scene.
struct Outcome {
  std::vector<VectorXd> frames;
  SimulatorStatistics simulator;
  DetectorStatistics detector;
  bool is_free = true;  ///< no contact from any frame to the next
};

Outcome run(Scene scene, ContactModel model, int steps, const DetectorOptions& detection = {}) {
  CollisionDetector detector(detection);
  Simulator simulator(std::move(scene), detector, model);
  const World& world = simulator.world();
  Outcome result;
  result.frames = {world.start()};
  for (int i = 0; i < steps; ++i) {
    simulator.take_time_step([&](const VectorXd& x) {
      result.is_free = result.is_free && world.step(result.frames.back(), x).is_free();
      result.frames.push_back(x);
    });
  }
  result.simulator = simulator.statistics();
  result.detector = detector.statistics();
  return result;
}

class Simulators : public testing::TestWithParam<ContactModel> {};

INSTANTIATE_TEST_SUITE_P(Models, Simulators,
                         testing::Values(ContactModel::barrier, ContactModel::constraint),
                         [](const auto& of) {
                           return of.param == ContactModel::barrier ? "Barrier" : "Constraint";
                         });

TEST_P(Simulators, AreFreeOfContactWithEachMethod) {
  for (const char* method : {"certified", "tight_inclusion"}) {
    const Outcome result = run(box_over_a_spike(), GetParam(), 10, {.method = method});
    EXPECT_TRUE(result.is_free) << method;
    EXPECT_GT(result.simulator.contacts, 0) << "nothing came near";
    EXPECT_EQ(result.simulator.unfinished, 0) << method;
    EXPECT_EQ(result.detector.steps_of_zero, 0) << method;
    EXPECT_EQ(result.detector.candidates > 0, std::string(method) == "tight_inclusion");
  }
}

TEST_P(Simulators, AreNotIfCollisionsAreMissed) {
  const Outcome result = run(box_over_a_spike(), GetParam(), 10, {.missed_one_in = 1});
  EXPECT_FALSE(result.is_free);
  EXPECT_GT(result.detector.missed, 0);
}

TEST_P(Simulators, FallFreelyWhereNothingIsNear) {
  Scene scene = box_over_a_spike();
  scene.bodies.pop_back();
  const Outcome result = run(scene, GetParam(), 5);
  // Implicit Euler: the path after n steps is g h² n (n + 1) / 2.
  const double way = 9.81 * scene.time_step * scene.time_step * 15.0;
  EXPECT_NEAR((result.frames.front() - result.frames.back())(2), way, 1e-9);
  EXPECT_NEAR((result.frames.front() - result.frames.back())(0), 0.0, 1e-9);
}

// ---- Recordings ---------------------------------------------------------------------------------

class Recorded : public tests::FolderTest {};

TEST_F(Recorded, QueriesComeBackWithTheTruth) {
  Recorder recorder(path("recorded"), "spike");
  const World world(box_over_a_spike());
  const fast::Step step = world.step(world.start(), lowered(world, 0.05));
  (void)CollisionDetector({.recorder = &recorder}).step_size(step);
  recorder.close();
  Recorder few(path("few"), "spike");
  (void)CollisionDetector({.recorder = &few, .record_limit = 4}).step_size(step);
  few.close();
  EXPECT_GT(recorder.collisions(ContactKind::edge_edge), 0);
  for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
    std::uint64_t queries = 0, collisions = 0;
    const std::string file = path("recorded") + "/" + std::string(to_string(kind)) + "/spike.npy";
    const auto source = verify::data::open_dataset(file, {});
    while (const auto query = source->next()) {
      ++queries;
      ASSERT_TRUE(query->collides.has_value());
      EXPECT_EQ(*query->collides, exact::decide(kind, query->query.straight()).collides());
      if (*query->collides) ++collisions;
    }
    EXPECT_GT(queries, 4U);
    EXPECT_EQ(few.queries(kind), 4U);
    EXPECT_EQ(queries, recorder.queries(kind));
    EXPECT_EQ(collisions, recorder.collisions(kind));
  }
}

}  // namespace
}  // namespace touchstone::simulation::simulation_test

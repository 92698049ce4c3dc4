#include "examples/simulation/simulator.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace touchstone::simulation::simulator_test {
namespace {

using Eigen::VectorXd;

/// The result of a scene.
struct Outcome {
  std::vector<VectorXd> frames;
  SimulatorStatistics simulator;
  DetectorStatistics detector;
  bool is_free = true;  ///< no contact from any frame to the next
};

template <class OfSimulator>
Outcome run(const Scene& scene, int steps, const DetectorOptions& detection = {}) {
  const World world(scene);
  CollisionDetector detector(detection);
  OfSimulator simulator(world, detector,
                        {.gravity = scene.gravity,
                         .time_step = scene.time_step,
                         .activation_distance = scene.activation_distance});
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

class BarrierScenes : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Erlebens, BarrierScenes,
                         testing::Values("spike", "wedge", "cliff-edge", "internal-edges", "crack",
                                         "hole"),
                         [](const auto& of) {
                           std::string name = of.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(BarrierScenes, AreFreeOfContact) {
  const Outcome result = run<BarrierSimulator>(make_scene(GetParam()), 10);
  EXPECT_TRUE(result.is_free);
  EXPECT_GT(result.simulator.contacts, 0) << "nothing came near";
  EXPECT_EQ(result.simulator.unfinished, 0);
  EXPECT_EQ(result.detector.steps_of_zero, 0);
}

// At the rim of the hole the barrier alone suffices, so that scene is not tested.
TEST_P(BarrierScenes, AreNotIfCollisionsAreMissed) {
  if (GetParam() == "hole") return;
  const Outcome result = run<BarrierSimulator>(make_scene(GetParam()), 10, {.missed_one_in = 1});
  EXPECT_FALSE(result.is_free);
  EXPECT_GT(result.detector.missed, 0);
}

TEST(BarrierSimulator, FallsFreelyWhereNothingIsNear) {
  Scene scene = make_scene("spike");
  scene.bodies.pop_back();
  const Outcome result = run<BarrierSimulator>(scene, 5);
  // Implicit Euler: the path after n steps is g h² n (n + 1) / 2.
  const double way = 9.81 * scene.time_step * scene.time_step * 15.0;
  EXPECT_NEAR((result.frames.front() - result.frames.back())(2), way, 1e-9);
  EXPECT_NEAR((result.frames.front() - result.frames.back())(0), 0.0, 1e-9);
}

TEST(BarrierSimulator, IsTheSameEachTime) {
  const Scene scene = make_scene("crack");
  EXPECT_EQ(run<BarrierSimulator>(scene, 6).frames, run<BarrierSimulator>(scene, 6).frames);
}

TEST(BarrierSimulator, IsFreeOfContactWithAConservativeMethod) {
  const Outcome result =
      run<BarrierSimulator>(make_scene("wedge"), 10, {.method = "tight_inclusion"});
  EXPECT_TRUE(result.is_free);
  EXPECT_GT(result.detector.candidates, 0);
}

TEST(ConstraintSimulator, KeepsABoxOnAPlane) {
  const Outcome result = run<ConstraintSimulator>(make_scene("internal-edges"), 10);
  EXPECT_TRUE(result.is_free);
  EXPECT_GT(result.simulator.contacts, 0);
  EXPECT_EQ(result.frames.size(), 11);
}

TEST(ConstraintSimulator, LetsItFallThroughIfCollisionsAreMissed) {
  const Outcome result =
      run<ConstraintSimulator>(make_scene("internal-edges"), 10, {.missed_one_in = 1});
  EXPECT_FALSE(result.is_free);
}

}  // namespace
}  // namespace touchstone::simulation::simulator_test

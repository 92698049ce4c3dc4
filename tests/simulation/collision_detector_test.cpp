#include "examples/simulation/collision_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "examples/simulation/world.hpp"

namespace touchstone::simulation::collision_detector_test {
namespace {

/// A box over a spike, and the box a tenth of a metre lower.
class FallingBox : public testing::Test {
 protected:
  FallingBox() : end_(world_.start()) {
    for (Eigen::Index i = 2; i < end_.size(); i += 3) {
      if (!world_.is_held(i)) end_[i] -= 0.1;
    }
  }

  [[nodiscard]] fast::Step step() const { return world_.step(world_.start(), end_); }

  World world_{make_scene("spike")};
  Eigen::VectorXd end_;
};

using Pairs = std::vector<std::pair<fast::PairKind, fast::IndexPair>>;

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
  const auto expected = whole.active_set(step(), 1e-3), found = by_pairs.active_set(step(), 1e-3);
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(pairs_of(expected), pairs_of(found));
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT((found[i].first - expected[i].first).norm(), 1e-6);
    EXPECT_LT((found[i].normal - expected[i].normal).norm(), 1e-4);
  }
}

TEST_F(FallingBox, HasAllOfItInTheActiveSetOfAConservativeMethod) {
  CollisionDetector certified({}), conservative({.method = "tight_inclusion"});
  const Pairs expected = pairs_of(certified.active_set(step(), 1e-3));
  const Pairs found = pairs_of(conservative.active_set(step(), 1e-3));
  EXPECT_TRUE(std::ranges::includes(found, expected));
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

// Two points that approach each other are neither a vertex and a face nor two edges.
TEST(CollisionDetector, LooksAtPointsToo) {
  const Eigen::RowVector3d away(1, 0, 0);
  Eigen::Matrix<double, 2, 3> before, after;
  before << Eigen::RowVector3d::Zero(), away;
  after << away, Eigen::RowVector3d::Zero();
  const std::vector<std::int32_t> points{0, 1};
  const fast::Step step(before, after, {.edges = {}, .faces = {}, .points = points});
  for (const char* method : {"certified", "tight_inclusion"}) {
    CollisionDetector detector({.method = method});
    EXPECT_LE(detector.step_size(step), 0.5) << method;
  }
}

TEST(CollisionDetector, RefusesAnUnknownMethod) {
  EXPECT_THROW(CollisionDetector({.method = "guess"}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::simulation::collision_detector_test

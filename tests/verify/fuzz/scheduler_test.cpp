#include "verify/fuzz/scheduler.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz::scheduler_test {
namespace {

std::vector<double> alike(std::size_t arms) { return std::vector<double>(arms, 1.0); }

TEST(CoverageTable, CountsHowOftenAKeyWasSeen) {
  CoverageTable table;
  EXPECT_EQ(table.add(7), 0U);
  EXPECT_EQ(table.add(8), 0U);
  EXPECT_EQ(table.add(7), 1U);
  EXPECT_EQ(table.add(7), 2U);
  EXPECT_EQ(table.size(), 2U);
}

TEST(Scheduler, GivesAllArmsAlikeBeforeItKnowsAnything) {
  const Scheduler scheduler(alike(4), 1);
  for (std::size_t arm = 0; arm < 4; ++arm) EXPECT_DOUBLE_EQ(scheduler.share(arm), 0.25);
}

/// Arm 3 of 8 pays once in 500 plays, the others never.
TEST(Scheduler, FindsTheArmThatPaysRarely) {
  Scheduler scheduler(alike(8), 1);
  generate::Random chance(5);
  std::vector<int> plays(8);
  constexpr int rounds = 40'000;
  for (int i = 0; i < rounds; ++i) {
    const std::size_t arm = scheduler.choose();
    ++plays.at(arm);
    const bool pays = arm == 3 && chance.bits() % 500 == 0;
    scheduler.learn(arm, pays ? 50.0 : 0.0, 1.0);
  }
  EXPECT_GT(plays[3], rounds / 3);
  // All other arms get a share of the exploration.
  for (const int count : plays) EXPECT_GT(count, rounds / 8 / 8);
}

TEST(Scheduler, PrefersWhatTakesLessWork) {
  Scheduler scheduler(alike(2), 1);
  for (int i = 0; i < 1000; ++i) {
    scheduler.learn(0, 1.0, 1.0);
    scheduler.learn(1, 1.0, 20.0);
  }
  EXPECT_GT(scheduler.share(0), 0.8);
}

TEST(Scheduler, ForgetsAnArmThatPaysNoMore) {
  Scheduler scheduler(alike(2), 1);
  for (int i = 0; i < 2000; ++i) scheduler.learn(0, 1.0, 1.0);
  EXPECT_GT(scheduler.share(0), 0.8);
  for (int i = 0; i < 100'000; ++i) scheduler.learn(0, 0.0, 1.0);
  EXPECT_LT(scheduler.share(0), 0.5);
}

TEST(Scheduler, LeavesEveryArmAShare) {
  Scheduler scheduler(alike(5), 1, {.explored = 0.25});
  for (int i = 0; i < 10'000; ++i) scheduler.learn(0, 1000.0, 1.0);
  double sum = 0.0;
  for (std::size_t arm = 0; arm < 5; ++arm) {
    EXPECT_GE(scheduler.share(arm), 0.05 - 1e-12);
    sum += scheduler.share(arm);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Scheduler, LeavesMoreToArmsOfGreaterParts) {
  Scheduler scheduler({3.0, 1.0, 1.0}, 1, {.explored = 0.25});
  EXPECT_DOUBLE_EQ(scheduler.share(0), 0.15 + 0.25);
  for (int i = 0; i < 10'000; ++i) scheduler.learn(2, 1000.0, 1.0);
  EXPECT_GE(scheduler.share(0), 0.15);
  EXPECT_NEAR(scheduler.share(1), 0.05, 0.001);
}

TEST(Scheduler, IsTheSameForTheSameSeed) {
  Scheduler a(alike(6), 9), b(alike(6), 9), other(alike(6), 10);
  int differences = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t arm = a.choose();
    ASSERT_EQ(arm, b.choose());
    differences += arm == other.choose() ? 0 : 1;
    for (Scheduler* scheduler : {&a, &b, &other}) {
      scheduler->learn(arm, static_cast<double>(arm), 1.0 + static_cast<double>(i % 3));
    }
  }
  EXPECT_GT(differences, 500);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::scheduler_test

#include "verify/baselines/accd.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::accd_test {
namespace {

using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::accd_method();

TEST(Accd, StepsAsDescribed) {
  // The vertex comes down by 1/2 and the face up by 1/2, with a mean motion up by 1/4: ℓ = 3/4 +
  // 1/4, and d = 1 − t. The first step, to 0.9, is not tested; the next would leave a gap of 0.01 <
  // 0.1.
  const auto posed = tests::vertex_face({1, 1, 0.5, 0, 0, -0.5, 4, 0, -0.5, 0, 4, -0.5},
                                        {1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const fast::Answer answer = answer_to(*method, posed);
  EXPECT_EQ(answer.verdict, fast::Verdict::yes);
  EXPECT_EQ(answer.toi_lower, 0.9);
  EXPECT_EQ(answer.checks, 2U);
}

TEST(Accd, StopsStrictlyBeforeContact) {
  tests::Random random(9);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (int i = 0; i < 1000; ++i) {
      const auto posed = tests::centre_hit(random, kind, tests::Movement::independent);
      const fast::Answer answer = answer_to(*method, posed);
      ASSERT_EQ(answer.verdict, fast::Verdict::yes) << posed;
      EXPECT_LT(answer.toi_lower, 0.5) << posed;
      EXPECT_TRUE(std::isnan(answer.toi_upper));
    }
  }
}

TEST(Accd, TakesMissesForCollisionsWhoseGapShrinksToATenthOrLimitedToAFifth) {
  const auto limited = baselines::accd_limited_method();
  const auto stops = [](const fast::Method& tested, const tests::PosedQuery& posed) {
    return answer_to(tested, posed).verdict == fast::Verdict::yes;
  };
  EXPECT_TRUE(stops(*method, over_triangle(1, 1, 1, 0.05))) << "a false positive";
  EXPECT_TRUE(stops(*method, over_edge(1, 2, 1, 0.05))) << "a false positive";
  EXPECT_FALSE(stops(*method, over_triangle(1, 1, 1, 0.2)));
  EXPECT_FALSE(stops(*method, over_edge(1, 2, 1, 0.2)));
  EXPECT_FALSE(stops(*method, over_triangle(1, 1, 1, 0.15)));
  EXPECT_TRUE(stops(*limited, over_triangle(1, 1, 1, 0.15))) << "a false positive";
  EXPECT_FALSE(stops(*limited, over_triangle(1, 1, 1, 0.3)));
}

TEST(Accd, KeepsTheSeparation) {
  const fast::MethodOptions options{.separation = {.distance = 0.25, .norm = Norm::l2}};
  for (const bool is_face : {true, false}) {
    const auto comes_down = [&](double from, double to) {
      return answer_to(*method, is_face ? over_triangle(1, 1, from, to) : over_edge(1, 2, from, to),
                       options);
    };
    // The distance 0.25 is reached at t=3/4.
    const fast::Answer collision = comes_down(1, 0);
    EXPECT_EQ(collision.verdict, fast::Verdict::yes);
    EXPECT_LT(collision.toi_lower, 0.75);
    EXPECT_GT(collision.toi_lower, 0.66);
    EXPECT_EQ(comes_down(1, 0.5).verdict, fast::Verdict::no);
    const fast::Answer at_start = comes_down(0.25, 1);
    EXPECT_EQ(at_start.verdict, fast::Verdict::yes);
    EXPECT_EQ(at_start.toi_lower, 0.0);
    EXPECT_EQ(at_start.checks, 0U);
  }
}

TEST(Accd, WithoutRelativeMotionOnlyTheStartCounts) {
  const auto together = [](double height) {
    return tests::vertex_face({1, 1, height, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                              {2, 1, height, 1, 0, 0, 5, 0, 0, 1, 4, 0});
  };
  EXPECT_EQ(answer_to(*method, together(0)).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, together(0x1p-30)).verdict, fast::Verdict::no);
}

TEST(Accd, StopsAtMaxChecks) {
  // The vertex moves along the face, above it by 2^-20.
  const auto grazing = tests::vertex_face({1, 1, 0x1p-20, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                          {2, 1, 0x1p-20, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const fast::Answer answer = answer_to(*method, grazing, {.max_checks = 1000});
  EXPECT_EQ(answer.verdict, fast::Verdict::yes) << "a false positive";
  EXPECT_EQ(answer.checks, 1000U);
  const fast::Answer all = answer_to(*method, grazing, {.max_checks = 0});
  EXPECT_EQ(all.verdict, fast::Verdict::no);
  EXPECT_GT(all.checks, 1000000U / 2);
}

/// The vertex comes down from 1 to −1 and moves along the face, `along` in all.
tests::PosedQuery comes_down_along(double along) {
  const double wide = 2.0 * along + 4.0;
  return tests::vertex_face({1, 1, 1, -wide, -wide, 0, wide, -wide, 0, 0, wide, 0},
                            {1 + along, 1, -1, -wide, -wide, 0, wide, -wide, 0, 0, wide, 0});
}

/// Each step covers a share of 0.8 · 2/√(along² + 4) of the gap, at most.
TEST(Accd, LimitedMissesContactsThatTakeMoreSteps) {
  const auto limited = baselines::accd_limited_method();
  EXPECT_EQ(limited->info().terms.starts_apart, 0.0);
  EXPECT_EQ(limited->promise(), fast::Promise::none);
  for (const double along : {0.0, 8.0}) {
    const fast::Answer found = answer_to(*limited, comes_down_along(along));
    EXPECT_EQ(found.verdict, fast::Verdict::yes);
    EXPECT_LT(found.toi_lower, 0.5);
  }
  const fast::Answer missed = answer_to(*limited, comes_down_along(100.0));
  EXPECT_EQ(missed.verdict, fast::Verdict::no) << "a false negative";
  EXPECT_EQ(missed.checks, 32U);
  EXPECT_TRUE(std::isnan(missed.toi_lower));
  EXPECT_EQ(answer_to(*method, comes_down_along(100.0)).verdict, fast::Verdict::yes);
}

}  // namespace
}  // namespace touchstone::baselines::accd_test

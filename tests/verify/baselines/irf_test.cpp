#include "verify/baselines/irf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::irf_test {
namespace {

using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;
using tests::Score;

const std::unique_ptr<fast::Method> method = baselines::irf_method();

/// Enough for nearly all queries, few enough for a test.
constexpr fast::MethodOptions quick{.max_checks = 2000};

void expect_no_miss(const Score& score) {
  EXPECT_GT(score.hits, 0);
  EXPECT_EQ(score.false_negatives, 0);
  EXPECT_EQ(score.errors, 0);
  EXPECT_GT(score.denied, score.misses / 4);
}

TEST(Irf, DecidesThePrintedQueries) {
  EXPECT_EQ(method->name(), "irf");
  EXPECT_EQ(method->promise(), fast::Promise::conservative);
  EXPECT_EQ(answer_to(*method, tests::printed_hourglass()).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, tests::printed_inflection()).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, tests::printed_coplanar()).verdict, fast::Verdict::yes);
}

TEST(Irf, MissesNothingInTheFamilies) {
  expect_no_miss(tests::score_on_families(*method, quick, 4));
}

TEST(Irf, MissesNothingAtRandom) { expect_no_miss(tests::score_on_random(*method, quick, 60)); }

TEST(Irf, MissesNoCentreHits) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const auto motion : {tests::Motion::independent, tests::Motion::translation}) {
      EXPECT_EQ(tests::missed_centre_hits(*method, kind, motion, {}, 40), 0);
    }
  }
}

TEST(Irf, MissesNothingOnThePublicData) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const std::string folder : {"handcrafted", "simulation"}) {
      const Score score = tests::score_on_public_data(*method, quick, folder, kind, 16);
      if (score.hits == 0) GTEST_SKIP() << "public data missing";
      EXPECT_EQ(score.false_negatives, 0) << folder;
      EXPECT_LT(score.undecided, score.hits + score.misses) << folder;
    }
  }
}

TEST(Irf, GivesNoTimes) {
  const fast::Answer answer = answer_to(*method, over_triangle(1, 1, 1, -3));
  EXPECT_EQ(answer.verdict, fast::Verdict::yes);
  EXPECT_TRUE(std::isnan(answer.toi_lower) && std::isnan(answer.toi_upper));
}

TEST(Irf, TakesNearMissesForCollisionsWithinItsToleranceOnly) {
  // Past the side u + v = 1 of the face; and past an edge, along the diagonal, an end of another that
  // stops short of it.
  const auto near_edges = [](double gap) {
    return tests::edge_edge({0, 0, 0, 4, 4, 0, 2.6, 0, 1, 1.3 + gap, 1.3 - gap, 1},
                            {0, 0, 0, 4, 4, 0, 2.6, 0, -1, 1.3 + gap, 1.3 - gap, -1});
  };
  for (const double tolerance : {1e-3, 1e-6}) {
    const fast::MethodOptions options{.tolerance = tolerance};
    for (const bool is_face : {true, false}) {
      const auto verdict = [&](double gap) {
        return answer_to(*method, is_face ? over_triangle(2 + gap, 2, 1, -1) : near_edges(gap),
                         options)
            .verdict;
      };
      EXPECT_EQ(verdict(tolerance / 16), fast::Verdict::yes) << "a false positive";
      EXPECT_EQ(verdict(16 * tolerance), fast::Verdict::no);
    }
  }
}

TEST(Irf, KnowsTheFaceFromTheParallelogramAroundIt) {
  EXPECT_EQ(answer_to(*method, over_triangle(1, 3, 1, -1)).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 3.01, 1, -1)).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, over_triangle(3, 3, 1, -1)).verdict, fast::Verdict::no);
}

TEST(Irf, StopsAtMaxChecks) {
  const fast::Answer few = answer_to(*method, over_triangle(1, 1, 1, -3), {.max_checks = 10});
  EXPECT_EQ(few.verdict, fast::Verdict::undecided);
  EXPECT_EQ(few.checks, 10U);
  const fast::Answer all = answer_to(*method, over_triangle(1, 1, 1, -3), {.max_checks = 0});
  EXPECT_EQ(all.verdict, fast::Verdict::yes);
}

TEST(Irf, CountsImpactsUpToTheGivenTime) {
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, -1), {.t_max = 0.5}).verdict,
            fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, -1), {.t_max = 0.49}).verdict,
            fast::Verdict::no);
}

TEST(Irf, KnowsNoSeparation) {
  EXPECT_EQ(
      answer_to(*method, over_triangle(1, 1, 1, 0.25), {.separation = {.distance = 0.5}}).verdict,
      fast::Verdict::no);
}

TEST(Irf, TakesWhatIsAtRest) {
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 0, 0)).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, 1)).verdict, fast::Verdict::no);
  const auto points = tests::vertex_face({1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3},
                                         {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3});
  const fast::Answer answer = answer_to(*method, points);
  EXPECT_EQ(answer.verdict, fast::Verdict::yes);
  EXPECT_EQ(answer.checks, 1U) << "no tolerance to reach";
}

}  // namespace
}  // namespace touchstone::baselines::irf_test

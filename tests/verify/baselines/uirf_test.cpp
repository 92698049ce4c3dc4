#include "verify/baselines/uirf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::uirf_test {
namespace {

using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;
using tests::Score;

const std::unique_ptr<fast::Method> method = baselines::uirf_method();

/// Enough for nearly all queries, few enough for a test.
constexpr fast::MethodOptions quick{.max_checks = 2000};

void expect_no_miss(const Score& score) {
  EXPECT_GT(score.hits, 0);
  EXPECT_EQ(score.false_negatives, 0);
  EXPECT_EQ(score.late, 0);
  EXPECT_EQ(score.errors, 0);
  EXPECT_GT(score.denied, score.misses / 4);
}

TEST(Uirf, DecidesThePrintedQueries) {
  EXPECT_EQ(method->name(), "uirf");
  EXPECT_EQ(method->promise(), fast::Promise::conservative);
  const fast::Answer hourglass = answer_to(*method, tests::printed_hourglass());
  EXPECT_EQ(hourglass.verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, tests::printed_inflection()).verdict, fast::Verdict::no);
  // Coplanar all the time: every small interval is a candidate.
  const fast::Answer coplanar = answer_to(*method, tests::printed_coplanar(), {.tolerance = 1e-4});
  EXPECT_EQ(coplanar.verdict, fast::Verdict::yes);
  EXPECT_NEAR(coplanar.toi_lower, 0.07 / 0.29, 1e-3);
  EXPECT_GT(coplanar.checks, 1000U);
}

TEST(Uirf, MissesNothingInTheFamilies) {
  expect_no_miss(tests::score_on_families(*method, quick, 4));
}

TEST(Uirf, MissesNothingAtRandom) { expect_no_miss(tests::score_on_random(*method, quick, 60)); }

TEST(Uirf, MissesNothingOnThePublicData) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const std::string folder : {"handcrafted", "simulation"}) {
      const Score score = tests::score_on_public_data(*method, quick, folder, kind, 16);
      if (score.hits == 0) GTEST_SKIP() << "public data missing";
      EXPECT_EQ(score.false_negatives, 0) << folder;
      EXPECT_EQ(score.late, 0) << folder;
      EXPECT_LT(score.undecided, score.hits + score.misses) << folder;
    }
  }
}

TEST(Uirf, GivesTimesThatAreNotLate) {
  tests::Random random(4);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (int i = 0; i < 50; ++i) {
      const auto posed = tests::centre_hit(random, kind, tests::Motion::independent);
      const fast::Answer answer = answer_to(*method, posed);
      ASSERT_EQ(answer.verdict, fast::Verdict::yes);
      const auto truth = exact::decide(kind, posed.query);
      ASSERT_TRUE(truth.collides());
      EXPECT_LE(exact::Rational(answer.toi_lower), truth.toi->enclosure().upper);
      EXPECT_TRUE(std::isnan(answer.toi_upper));
    }
  }
}

TEST(Uirf, PassesAllThatIsOnOneLine) {
  // Two edges on one line, far from each other, at rest; and such a triangle with its vertex.
  const auto edges = tests::edge_edge({0, 0, 0, 1, 0, 0, 8, 0, 0, 9, 0, 0},  //
                                      {0, 0, 0, 1, 0, 0, 8, 0, 0, 9, 0, 0});
  EXPECT_EQ(answer_to(*method, edges).verdict, fast::Verdict::yes);
  const auto needle = tests::vertex_face({9, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0},  //
                                         {9, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0});
  const fast::Answer answer = answer_to(*method, needle);
  EXPECT_EQ(answer.verdict, fast::Verdict::yes);
  EXPECT_EQ(answer.checks, 1U) << "at rest, [0,1] itself is decided";
}

TEST(Uirf, PassesThePlaneOutsideTheFace) {
  EXPECT_EQ(answer_to(*method, over_triangle(1, 3, 1, -1)).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 3.01, 1, -1)).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, over_edge(1, 2, 1, -1)).verdict, fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_edge(4.01, 2, 1, -1)).verdict, fast::Verdict::no);
}

TEST(Uirf, StopsAtMaxChecks) {
  // In one plane all the time, apart.
  const auto plane = tests::vertex_face({3, 3, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0},  //
                                        {3, 4, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const fast::Answer few = answer_to(*method, plane, {.max_checks = 100});
  EXPECT_EQ(few.verdict, fast::Verdict::undecided);
  EXPECT_EQ(few.checks, 100U);
  const fast::Answer all = answer_to(*method, plane, {.tolerance = 1e-3, .max_checks = 0});
  EXPECT_EQ(all.verdict, fast::Verdict::no);
  EXPECT_EQ(all.checks, 2047U) << "all intervals of 2^-10 are candidates";
}

TEST(Uirf, CountsImpactsUpToTheGivenTime) {
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, -1), {.t_max = 0.5}).verdict,
            fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, -1), {.t_max = 0.49}).verdict,
            fast::Verdict::no);
}

TEST(Uirf, KnowsNoSeparation) {
  EXPECT_EQ(
      answer_to(*method, over_triangle(1, 1, 1, 0.25), {.separation = {.distance = 0.5}}).verdict,
      fast::Verdict::no);
}

}  // namespace
}  // namespace touchstone::baselines::uirf_test

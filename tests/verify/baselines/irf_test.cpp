#include "verify/baselines/irf.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::irf_test {
namespace {

using tests::answer_to;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::irf_method();

TEST(Irf, TakesNearMissesForCollisionsWithinItsToleranceOnly) {
  // A path past the side u + v = 1 of the face; and an edge whose end stops short of the other,
  // diagonal one.
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

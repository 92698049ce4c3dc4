#include "verify/baselines/msrf.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::msrf_test {
namespace {

using tests::answer_to;
using tests::missed_centre_hits;
using tests::Movement;
using tests::over_edge;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::msrf_method();
constexpr int collisions = 4000;

constexpr fast::MethodOptions within(double h) {
  return {.separation = {.distance = h, .norm = Norm::l2}};
}

TEST(Msrf, AnswersThePrintedQueriesAsItWasSeenTo) {
  for (const double h : {1e-16, 1e-30, 1e-100}) {
    EXPECT_EQ(answer_to(*method, tests::printed_query("hourglass"), within(h)).verdict,
              fast::Verdict::no)
        << h;
  }
  const fast::Answer hourglass =
      answer_to(*method, tests::printed_query("hourglass"), within(1e-8));
  EXPECT_EQ(hourglass.verdict, fast::Verdict::yes);
  EXPECT_NEAR(hourglass.toi_lower, 0.9, 1e-4);
  EXPECT_EQ(answer_to(*method, tests::printed_query("inflection"), within(1e-8)).verdict,
            fast::Verdict::no);
}

TEST(Msrf, MissesTheMoreTheSmallerItsSeparation) {
  const auto share = [](Kind kind, double h) {
    return static_cast<double>(
               missed_centre_hits(*method, kind, Movement::independent, within(h), collisions)) /
           collisions;
  };
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    EXPECT_GT(share(kind, 1e-100), 0.995) << to_string(kind);
    EXPECT_NEAR(share(kind, 1e-8), 0.045, 0.015) << to_string(kind);
    EXPECT_LT(share(kind, 1e-2), 0.002) << to_string(kind);
  }
}

TEST(Msrf, ReachesTheRootOfItsSeparation) {
  // √(h² + 0.1 h) = 3.16e-5 for h = 1e-8: the distance at which a vertex just misses an edge.
  const auto passes_at = [](double distance) {
    return answer_to(*method, over_triangle(-distance, 1, 1, -1), within(1e-8)).verdict;
  };
  EXPECT_EQ(passes_at(3e-5), fast::Verdict::yes) << "a false positive";
  EXPECT_EQ(passes_at(3.3e-5), fast::Verdict::no);
}

TEST(Msrf, MissesWhatIsWithinItsSeparationFromTheStart) {
  // A moving vertex that is always within 0.5.
  const auto near = tests::vertex_face({1, 1, 0.25, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                       {1.5, 1, 0.125, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  EXPECT_EQ(answer_to(*method, near, within(0.5)).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 1, 0.25), within(0.5)).verdict,
            fast::Verdict::yes);
  // All points rest: every polynomial is constant or 0.
  EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 0, 0)).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, {Kind::vertex_face, Query{}}).verdict, fast::Verdict::no);
}

TEST(Msrf, MissesEndsOfEdgesAndParallelEdges) {
  // An end is 0.25 beside the other edge's end, where the distance of the lines is 0.
  EXPECT_EQ(answer_to(*method, over_edge(4.25, 2, 1, -1), within(0.25)).verdict, fast::Verdict::no);
  const auto parallel = tests::edge_edge({0, 0, 0, 4, 0, 0, 1, 0, 1, 3, 0, 1},  //
                                         {0, 0, 0, 4, 0, 0, 1, 0, -1, 3, 0, -1});
  EXPECT_EQ(answer_to(*method, parallel, within(0.25)).verdict, fast::Verdict::no);
  // A vertex has candidates for the edges and vertices of a face.
  EXPECT_EQ(answer_to(*method, over_triangle(-0.125, 1, 1, -1), within(0.25)).verdict,
            fast::Verdict::yes);
  EXPECT_EQ(answer_to(*method, over_triangle(-0.125, -0.125, 1, -1), within(0.25)).verdict,
            fast::Verdict::yes);
}

TEST(Msrf, QuickTestsRuleOutZerosToo) {
  const auto ruled_out = [](std::array<double, 7> c) { return msrf_rules_out_zeros(c); };
  // 10 − 9t − 1.25t⁶ is 10 at 0 and −0.25 at 1; without the last it is 1 there.
  EXPECT_TRUE(ruled_out({10, -9, 0, 0, 0, 0, -1.25}));
  EXPECT_FALSE(ruled_out({10, -9, 0, 0, 0, 0, -1.5})) << "not steep enough to be sure: 9 = 6 · 1.5";
  // t² is 0 at 0.
  EXPECT_TRUE(ruled_out({0, 0, 1, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace touchstone::baselines::msrf_test

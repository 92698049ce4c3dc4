#include "verify/baselines/cubic.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::cubic_test {
namespace {

using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::cubic_method();

TEST(Cubic, FindsContactsInTheMiddleAndTheirTimes) {
  EXPECT_EQ(method->info().terms.times, fast::Times::estimates);
  tests::Random random(9);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (int i = 0; i < 1000; ++i) {
      const auto posed = tests::centre_hit(random, kind, tests::Movement::independent);
      const fast::Answer answer = answer_to(*method, posed);
      ASSERT_EQ(answer.verdict, fast::Verdict::yes) << posed;
      EXPECT_LT(answer.toi_lower, 0.5 + 1e-6) << posed;
    }
  }
}

TEST(Cubic, TakesPassesWithinItsToleranceForCollisions) {
  for (const bool is_face : {true, false}) {
    const auto stops_at = [&](double gap) {
      return answer_to(*method, is_face ? over_triangle(1, 1, 1, gap) : over_edge(1, 2, 1, gap),
                       {.tolerance = 1e-4})
          .verdict;
    };
    EXPECT_EQ(stops_at(5e-5), fast::Verdict::yes) << "a false positive";
    EXPECT_EQ(stops_at(2e-4), fast::Verdict::no);
  }
}

TEST(Cubic, FindsContactAtTheEnds) {
  for (const bool is_face : {true, false}) {
    const auto moves = [&](double from, double to) {
      return answer_to(*method,
                       is_face ? over_triangle(1, 1, from, to) : over_edge(1, 2, from, to));
    };
    EXPECT_EQ(moves(0, 1).toi_lower, 0.0);
    EXPECT_EQ(moves(1, 0).toi_lower, 1.0);
    EXPECT_EQ(moves(1, 2).verdict, fast::Verdict::no);
  }
}

/// In a plane the cubic is 0: a vertex enters a triangle by an edge, and leaves it.
TEST(Cubic, MissesContactsInAPlane) {
  const auto through = tests::vertex_face({-1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                          {5, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  EXPECT_EQ(answer_to(*method, through).verdict, fast::Verdict::no) << "a false negative";
}

}  // namespace
}  // namespace touchstone::baselines::cubic_test

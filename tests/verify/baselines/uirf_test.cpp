#include "verify/baselines/uirf.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::uirf_test {
namespace {

using tests::answer_to;
using tests::over_edge;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::uirf_method();

TEST(Uirf, PassesAllThatIsOnOneLine) {
  // Two edges on one line, far from each other, at rest; and a triangle on a line with its vertex.
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
  // Primitives that are always in one plane, and apart.
  const auto plane = tests::vertex_face({3, 3, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0},  //
                                        {3, 4, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const fast::Answer few = answer_to(*method, plane, {.max_checks = 100});
  EXPECT_EQ(few.verdict, fast::Verdict::undecided);
  EXPECT_EQ(few.checks, 100U);
  const fast::Answer all = answer_to(*method, plane, {.tolerance = 1e-3, .max_checks = 0});
  EXPECT_EQ(all.verdict, fast::Verdict::no);
  EXPECT_EQ(all.checks, 2047U) << "all intervals of 2^-10 are candidates";
}

}  // namespace
}  // namespace touchstone::baselines::uirf_test

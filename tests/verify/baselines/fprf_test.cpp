#include "verify/baselines/fprf.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/baselines.hpp"

namespace touchstone::baselines::fprf_test {
namespace {

using tests::answer_to;
using tests::missed_centre_hits;
using tests::Movement;
using tests::over_edge;
using tests::over_triangle;

const std::unique_ptr<fast::Method> method = baselines::fprf_method();
constexpr fast::MethodOptions wide{.separation = {.distance = 1e-3, .norm = Norm::l2}};
constexpr int collisions = 2000;

TEST(Fprf, MissesDeformingTrianglesWhateverItsSeparation) {
  const int missed =
      missed_centre_hits(*method, Kind::vertex_face, Movement::independent, wide, collisions);
  EXPECT_NEAR(missed, 0.288 * collisions, 0.04 * collisions);
  EXPECT_EQ(missed_centre_hits(*method, Kind::vertex_face, Movement::translation, wide, collisions),
            0);
  EXPECT_EQ(missed_centre_hits(*method, Kind::edge_edge, Movement::independent, wide, collisions),
            0);
  EXPECT_EQ(missed_centre_hits(*method, Kind::edge_edge, Movement::translation, wide, collisions),
            0);
}

TEST(Fprf, MissesByChanceWithoutASeparation) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const int missed = missed_centre_hits(*method, kind, Movement::translation, {}, collisions);
    EXPECT_GT(missed, collisions / 20) << to_string(kind);
    EXPECT_LT(missed, collisions) << to_string(kind);
  }
}

TEST(Fprf, MissesParallelEdges) {
  // The edges meet along a segment at t=1/2; so they do with a separation.
  const auto parallel = tests::edge_edge({0, 0, 0, 4, 0, 0, 1, 0, 1, 3, 0, 1},  //
                                         {0, 0, 0, 4, 0, 0, 1, 0, -1, 3, 0, -1});
  EXPECT_EQ(answer_to(*method, parallel).verdict, fast::Verdict::no);
  EXPECT_EQ(answer_to(*method, parallel, wide).verdict, fast::Verdict::no);
  // Small edges all count as parallel.
  auto crossing = over_edge(1, 2, 1, -1);
  EXPECT_EQ(answer_to(*method, crossing).verdict, fast::Verdict::yes);
  for (double& x : crossing.query.coordinates) x *= 0x1p-16;
  EXPECT_EQ(answer_to(*method, crossing).verdict, fast::Verdict::no);
}

TEST(Fprf, SeparatesInteriorsOnly) {
  for (const double gap : {0.25, 0.75}) {
    const fast::Verdict expected = gap < 0.5 ? fast::Verdict::yes : fast::Verdict::no;
    const fast::MethodOptions options{.separation = {.distance = 0.5, .norm = Norm::l2}};
    EXPECT_EQ(answer_to(*method, over_triangle(1, 1, 2, gap), options).verdict, expected);
    EXPECT_EQ(answer_to(*method, over_edge(1, 2, 2, gap), options).verdict, expected);
    // Contacts beside the primitives at that distance are not found.
    EXPECT_EQ(answer_to(*method, over_triangle(-gap, 1, 2, -2), options).verdict,
              fast::Verdict::no);
    EXPECT_EQ(answer_to(*method, over_edge(4 + gap, 2, 2, -2), options).verdict, fast::Verdict::no);
  }
}

}  // namespace
}  // namespace touchstone::baselines::fprf_test

#include "verify/judge/terms.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/queries.hpp"

namespace touchstone::verify::judge::terms_test {
namespace {

using fast::Terms;
using fast::Times;

/// A vertex that falls from that height onto a triangle.
Query falling(double height) { return tests::over_triangle(1, 1, height, -2).query; }

TEST(Terms, TheUsualOnesAdmitAllAndChangeNothing) {
  EXPECT_FALSE(select_queries({}));
  EXPECT_FALSE(select_queries({.times = Times::none}));
  const Query query = falling(0.1);
  EXPECT_EQ(as_asked({}, query), query);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    EXPECT_TRUE(admits({}, kind, falling(0), {}));
  }
  EXPECT_EQ(to_text(Terms{}), "");
  EXPECT_EQ(as_options({}), "");
}

TEST(Terms, LeaveOutAKind) {
  const Terms terms{.edge_edge = false};
  EXPECT_TRUE(select_queries(terms));
  EXPECT_TRUE(admits(terms, Kind::vertex_face, falling(1), {}));
  EXPECT_FALSE(admits(terms, Kind::edge_edge, falling(1), {}));
}

TEST(Terms, TheStartIsApartByMoreThanSeparationAndDistance) {
  const auto apart = [](double distance, double height, double separation) {
    return admits({.starts_apart = distance}, Kind::vertex_face, falling(height),
                  {separation, Norm::l2});
  };
  EXPECT_FALSE(apart(0, 0, 0));
  EXPECT_TRUE(apart(0, 0x1p-1000, 0));
  EXPECT_FALSE(apart(0, 1, 1));
  EXPECT_TRUE(apart(0, 1, 0.5));
  EXPECT_FALSE(apart(0.5, 1, 0.5));
  EXPECT_TRUE(apart(0.25, 1, 0.5));
}

TEST(Terms, FloatCoordinatesAreRounded) {
  const Terms terms{.float_coordinates = true};
  const Query query = falling(0.1), asked = as_asked(terms, query);
  EXPECT_NE(asked, query);
  EXPECT_EQ(as_asked(terms, asked), asked);
  EXPECT_FALSE(admits(terms, Kind::vertex_face, query, {}));
  EXPECT_TRUE(admits(terms, Kind::vertex_face, asked, {}));
  const Query huge = as_asked(terms, falling(1e300));
  EXPECT_FALSE(is_finite(huge));
  EXPECT_FALSE(admits(terms, Kind::vertex_face, huge, {}));
}

TEST(Terms, AreSaidInWordsAndAsOptions) {
  const Terms terms{.edge_edge = false,
                    .starts_apart = 0.0,
                    .float_coordinates = true,
                    .times = Times::estimates,
                    .time_error = 0.5};
  EXPECT_EQ(to_text(terms),
            ", vertex-face alone, starts apart, float coordinates, times are estimates to 0.5");
  EXPECT_EQ(as_options(terms),
            " --kinds vertex-face --starts-apart=0 --float-coordinates --times estimates "
            "--time-error 0.5");
  EXPECT_EQ(as_options({.vertex_face = false, .times = Times::none}),
            " --kinds edge-edge --times none");
}

}  // namespace
}  // namespace touchstone::verify::judge::terms_test

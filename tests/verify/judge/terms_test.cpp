#include "verify/judge/terms.hpp"

#include <gtest/gtest.h>

#include "tests/support/queries.hpp"

namespace touchstone::verify::judge::terms_test {
namespace {

using fast::Terms;

/// A vertex that falls from that height onto a triangle.
Query falling(double height) { return tests::over_triangle(1, 1, height, -2).query; }

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

}  // namespace
}  // namespace touchstone::verify::judge::terms_test

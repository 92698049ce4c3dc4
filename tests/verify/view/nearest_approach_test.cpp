#include "verify/view/query_facts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::view::nearest_approach_test {
namespace {

using tests::PosedQuery;

constexpr double least = std::numeric_limits<double>::denorm_min();

TEST(NearestApproach, IsBetweenNeighbouringDoubles) {
  for (const double height : {0.5, 1e-9, 0x1p-53, 1e-310, least}) {
    const PosedQuery posed = tests::over_triangle(1, 1, 1, height);
    const auto approach = nearest_approach(posed.kind, posed.query);
    ASSERT_TRUE(approach);
    EXPECT_EQ(approach->at_most, height);
    EXPECT_EQ(approach->above, std::nextafter(height, 0.0));
    EXPECT_EQ(approach->time, exact::AlgebraicNumber(1));
  }
}

/// Two edges that pass each other, one at height 3: their distance is least while they cross in
/// projection.
TEST(NearestApproach, IsTheFirstTimeOfTheLeastDistance) {
  const PosedQuery passing = tests::edge_edge({-1, 0, 3, 1, 0, 3, 0, 3, 0, 0, 5, 0},
                                              {-1, 0, 3, 1, 0, 3, 0, -5, 0, 0, -3, 0});
  const auto approach = nearest_approach(passing.kind, passing.query);
  ASSERT_TRUE(approach);
  EXPECT_EQ(approach->at_most, 3.0);
  // The nearer end is at y = 3 - 8t, 0 at t = 3/8.
  EXPECT_EQ(approach->time, exact::AlgebraicNumber(exact::Rational(3, 8)));
}

TEST(NearestApproach, AgreesWithTheOracleOnBothSides) {
  tests::Random random(20261123);
  int asked = 0;
  for (int i = 0; i < 200; ++i) {
    PosedQuery posed{i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge, {}};
    for (double& x : posed.query.coordinates) x = random.between(-1 << 20, 1 << 20) * 0x1p-20;
    const auto approach = nearest_approach(posed.kind, posed.query);
    const auto collides = [&](double d) {
      return exact::decide(posed.kind, posed.query, {.distance = d, .norm = Norm::l2}).collides();
    };
    ASSERT_EQ(!approach, collides(0.0)) << posed;
    if (!approach) continue;
    ++asked;
    EXPECT_EQ(approach->at_most, std::nextafter(approach->above, 2.0 * approach->above));
    EXPECT_FALSE(collides(approach->above)) << posed;
    EXPECT_TRUE(collides(approach->at_most)) << posed;
  }
  EXPECT_GT(asked, 50);
}

TEST(NearestApproach, BeyondEveryDoubleDoesNotExist) {
  constexpr double greatest = std::numeric_limits<double>::max();
  const PosedQuery far =
      tests::vertex_face({greatest, 0, 0, -greatest, 0, 0, -greatest, 1, 0, -greatest, 0, 1},
                         {greatest, 0, 0, -greatest, 0, 0, -greatest, 1, 0, -greatest, 0, 1});
  EXPECT_FALSE(nearest_approach(far.kind, far.query));
}

}  // namespace
}  // namespace touchstone::verify::view::nearest_approach_test

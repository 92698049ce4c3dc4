#include "exact/certificate/separation_intervals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::exact {

/// Prints a subinterval in messages of failed expectations.
void PrintTo(const Subinterval& subinterval, std::ostream* out) {
  const auto& [from, to, feature] = subinterval;
  *out << '[' << from << ", " << to << "] " << static_cast<int>(feature.sort) << ' ' << feature.i
       << ' ' << feature.j << ' ' << feature.axis;
}

namespace {

using tests::over_triangle;
using tests::PosedQuery;
using Sort = Feature::Sort;

constexpr Feature face_above{.sort = Sort::positive_face};
constexpr Feature face_below{.sort = Sort::negative_face};

std::vector<Subinterval> separate_all(const PosedQuery& posed) {
  return separate(scale_uniformly(posed.kind, posed.query), 1);
}

std::vector<Subinterval> one(const Feature& feature) { return {{0, 1, feature}}; }

/// All corners are one point that moves from (−a,1,0) to (b,1,0): it is nearest at a/(a+b).
Motion passing_point(const Integer& a, const Integer& b, const Integer& distance) {
  Motion motion{.kind = Kind::vertex_face, .points = {}, .corners = {}, .corner_count = 3};
  for (std::size_t i = 0; i < motion.corner_count; ++i) {
    motion.corners[i][0].c = {Integer(-a), b};
    motion.corners[i][1].c = {distance, distance};
  }
  return motion;
}

void expect_cover(const std::vector<Subinterval>& subintervals, const Rational& until) {
  ASSERT_FALSE(subintervals.empty());
  EXPECT_EQ(subintervals.back().to, until);
  for (std::size_t i = 0; i < subintervals.size(); ++i) {
    EXPECT_LE(subintervals[i].from, subintervals[i].to);
    EXPECT_EQ(subintervals[i].from, i == 0 ? Rational(0) : subintervals[i - 1].to);
  }
}

TEST(Separate, TakesEachFeatureForWhatItIs) {
  EXPECT_EQ(separate_all(over_triangle(1, 1, 3, 1)), one(face_above));
  EXPECT_EQ(separate_all(over_triangle(1, 1, -3, -1)), one(face_below));
  // Paths through the triangle's plane, beside a corner and beside a side.
  EXPECT_EQ(separate_all(over_triangle(-1, -1, 1, -1)), one({.sort = Sort::vertex, .i = 0}));
  EXPECT_EQ(separate_all(over_triangle(2, -0.5, 1, -1)), one({.sort = Sort::edge, .i = 0, .j = 1}));
  EXPECT_EQ(separate_all(over_triangle(-0.5, 2, 1, -1)), one({.sort = Sort::edge, .i = 2, .j = 0}));
  EXPECT_EQ(separate_all(tests::over_edge(1, 2, 3, 1)).size(), 1U);
  // Parallel edges beside each other: the area is 0, so that a side of the parallelogram separates.
  const auto parallel = tests::edge_edge({0, 0, 0, 4, 0, 0, -1, 1, 0, 3, 1, 0},
                                         {0, 0, 0, 4, 0, 0, -1, 2, 0, 3, 2, 0});
  const auto subintervals = separate_all(parallel);
  ASSERT_EQ(subintervals.size(), 1U);
  EXPECT_EQ(subintervals.front().feature.sort, Sort::edge);
}

TEST(Separate, BreaksAtAShortNumberBetweenTwoFeatures) {
  // A path from above the triangle over its side x = 0 at 2/9, then down through its plane at 1/3.
  // The side separates from shortly before 2/9.
  const auto posed = tests::vertex_face({1, 1, 0.125, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                        {-3.5, 1, -0.25, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  const Rational quarter(1, 4);
  const std::vector<Subinterval> expected{{0, quarter, face_above},
                                          {quarter, 1, {.sort = Sort::edge, .i = 2, .j = 0}}};
  EXPECT_EQ(separate_all(posed), expected);
}

TEST(Separate, EndsAtTheGivenTime) {
  const auto falling = over_triangle(1, 1, 3, -1);  // contact at 3/4
  const Motion motion = scale_uniformly(falling.kind, falling.query);
  const Rational until = Rational(3, 4) - power_of_two(-300);
  EXPECT_EQ(separate(motion, until), (std::vector<Subinterval>{{0, until, face_above}}));
  EXPECT_EQ(separate(motion, 0), (std::vector<Subinterval>{{0, 0, face_above}}));
  EXPECT_THROW(static_cast<void>(separate(motion, Rational(3, 4))), std::logic_error);
  EXPECT_THROW(static_cast<void>(separate(motion, 1)), std::logic_error);
}

TEST(Separate, TakesACubesEdgeWhereNothingElseSeparates) {
  // (6,2) is 2 from the side in x = y. The triangle leans away from it: its plane is nearer, and
  // all coordinates of the vertex are between those of the triangle.
  const std::array<double, 9> face{0, 0, 0, 8, 8, 0, 2, 6, -8};
  const auto posed = tests::vertex_face(tests::with_vertex(6, 2, -0.25, face),
                                        tests::with_vertex(6, 2, -0.5, face));
  const Motion motion = scale_uniformly(posed.kind, posed.query, {1.9, Norm::linf});
  const auto subintervals = separate(motion, 1);
  ASSERT_EQ(subintervals.size(), 1U);
  EXPECT_EQ(subintervals.front().feature.sort, Sort::cross);
}

TEST(Separate, BreaksWhatACheckerDoesNotReach) {
  const Integer far = Integer(1) << 1000U;
  // A depth of 100 needs no break; one of 1000 needs one on each side of the nearest time.
  EXPECT_EQ(separate(passing_point(far, 2 * far, Integer(1) << 900U), 1).size(), 1U);
  const auto subintervals = separate(passing_point(far, 2 * far, 1), 1);
  expect_cover(subintervals, 1);
  ASSERT_EQ(subintervals.size(), 3U);
  EXPECT_LT(subintervals[1].from, Rational(1, 3));
  EXPECT_GT(subintervals[1].to, Rational(1, 3));
  // Nothing is deep at a time that a bisection reaches.
  EXPECT_EQ(separate(passing_point(far, far, 1), 1).size(), 1U);
}

TEST(Separate, SaysSoWhereTheLimitsCannotBeKept) {
  // This takes half a minute, mostly for the isolation of roots so close together.
  if (!tests::is_soak()) {
    GTEST_SKIP() << "in the soak only";
  }
  const Integer far = Integer(1) << 17000U;
  EXPECT_THROW(static_cast<void>(separate(passing_point(far, 2 * far, 1), 1)),
               CertificateLimitError);
}

TEST(IsWithinLimit, CountsTheBitsOfBothParts) {
  const Integer most = (Integer(1) << number_limit) - 1;
  EXPECT_TRUE(is_within_limit(Rational(most)));
  EXPECT_TRUE(is_within_limit(Rational(Integer(1), most)));
  EXPECT_TRUE(is_within_limit(Rational(Integer(-most), most - 1)));
  EXPECT_FALSE(is_within_limit(Rational(most + 1)));
  EXPECT_FALSE(is_within_limit(power_of_two(-static_cast<long>(number_limit))));
}

}  // namespace
}  // namespace touchstone::exact

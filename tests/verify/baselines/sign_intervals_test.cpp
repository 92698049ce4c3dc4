#include "verify/baselines/sign_intervals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace touchstone::baselines::sign_intervals_test {
namespace {

using Intervals = std::vector<TimeInterval>;

Intervals not_negative(const std::vector<double>& coefficients) {
  return sign_intervals(coefficients, WantedSign::not_negative);
}

Intervals not_positive(const std::vector<double>& coefficients) {
  return sign_intervals(coefficients, WantedSign::not_positive);
}

struct Row {
  const char* name;
  std::vector<double> coefficients;
  Intervals not_negative, not_positive;
};

TEST(SignIntervals, OfConstantsLinesAndParabolas) {
  const Intervals all{{0, 1}}, none;
  const std::array rows{
      Row{"positive", {2.0}, all, none},
      Row{"negative", {-2.0}, none, all},
      Row{"leading zeros are left out", {0.0, 0.0, 3.0}, all, none},
      Row{"a zero inside", {2.0, -1.0}, {{0.5, 1}}, {{0, 0.5}}},
      Row{"two zeros", {16.0, -16.0, 3.0}, {{0, 0.25}, {0.75, 1}}, {{0.25, 0.75}}},
      Row{"no zeros", {1.0, 0.0, 1.0}, all, none},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(not_negative(row.coefficients), row.not_negative) << row.name;
    EXPECT_EQ(not_positive(row.coefficients), row.not_positive) << row.name;
  }
  EXPECT_EQ(not_positive({0.0, 0.0, 0.0}), all);
  EXPECT_EQ(not_negative({1.0, 1.0}), all) << "zero before";
  EXPECT_EQ(not_negative({1.0, -2.0}), none) << "zero after";
  EXPECT_EQ(not_negative({1.0, -1.0}), (Intervals{{1, 1}})) << "of no length";
  EXPECT_EQ(not_positive({4.0, -4.0, 1.0}), (Intervals{{0.5, 0.5}})) << "a double zero";
}

TEST(SignIntervals, OfASquareWithoutAnythingElseAreItsZeroAlone) {
  EXPECT_EQ(not_negative({1.0, 0.0, 0.0}), (Intervals{{0, 0}}));
}

TEST(SignIntervals, OfCubics) {
  // (4t − 1)(4t − 2)(4t − 3)
  const std::vector<double> cubic{64.0, -96.0, 44.0, -6.0};
  const Intervals positive = not_negative(cubic);
  ASSERT_EQ(positive.size(), 2U);
  EXPECT_NEAR(positive[0].from, 0.25, 1e-12);
  EXPECT_NEAR(positive[0].to, 0.5, 1e-12);
  EXPECT_NEAR(positive[1].from, 0.75, 1e-12);
  EXPECT_EQ(positive[1].to, 1.0);
  EXPECT_EQ(not_positive(cubic).size(), 2U);
  EXPECT_EQ(not_negative({1.0, 1.0, -9.0, -2.5}), Intervals{}) << "all that helps is not enough";
}

TEST(SignIntervals, RealPartsOfComplexZerosCutToo) {
  // ((t − 1/2)² + 1)(t + 1)
  const Intervals all = not_negative({1.0, 0.0, 0.25, 1.25});
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].from, 0.0);
  EXPECT_NEAR(all[0].to, 0.5, 1e-12);
  EXPECT_EQ(all[1].from, all[1].to) << "both of the pair";
  EXPECT_EQ(all[2].to, 1.0);
}

TEST(SignIntervals, DoNotDependOnTheScale) {
  for (const double scale : {1e-300, 1e300}) {
    EXPECT_EQ(not_positive({4.0 * scale, -4.0 * scale, scale}).size(), 1U) << scale;
  }
}

}  // namespace
}  // namespace touchstone::baselines::sign_intervals_test

#include "verify/baselines/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/number.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines::intervals_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool holds(const Interval& interval, const Rational& value) {
  return Rational(interval.lower()) <= value && value <= Rational(interval.upper());
}

/// True if it is the narrowest interval of doubles that holds the value.
bool is_tight(const Interval& interval, const Rational& value) {
  if (!holds(interval, value)) return false;
  if (interval.lower() == interval.upper()) return true;
  return std::nextafter(interval.lower(), infinity) == interval.upper() &&
         Rational(interval.lower()) != value && Rational(interval.upper()) != value;
}

TEST(Intervals, OperationsOnNumbersAreTight) {
  Random random(1);
  int wide = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.few_bit_double(53, -60, 4);
    const double y = random.few_bit_double(53, -60, 4);
    const Interval sum = Interval(x) + Interval(y);
    const Interval difference = Interval(x) - Interval(y);
    const Interval product = Interval(x) * Interval(y);
    EXPECT_TRUE(is_tight(sum, Rational(x) + Rational(y))) << x << ' ' << y;
    EXPECT_TRUE(is_tight(difference, Rational(x) - Rational(y))) << x << ' ' << y;
    EXPECT_TRUE(is_tight(product, Rational(x) * Rational(y))) << x << ' ' << y;
    wide += product.lower() < product.upper() ? 1 : 0;
  }
  EXPECT_GT(wide, 9000) << "two directions give two numbers";
}

TEST(Intervals, HoldWhatOverflows) {
  const double huge = std::numeric_limits<double>::max();
  const Interval x = (Interval(huge) - Interval(-huge)) * Interval(0.0, 1.0) + Interval(-huge);
  EXPECT_EQ(x.lower(), -huge);
  EXPECT_EQ(x.upper(), infinity);
  EXPECT_TRUE(may_be_zero(x));
}

TEST(Intervals, MayBeZeroUnlessTheyExcludeIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(may_be_zero(Interval(-1.0, 1.0)));
  EXPECT_TRUE(may_be_zero(Interval(0.0, 1.0)));
  EXPECT_TRUE(may_be_zero(Interval(-1.0, 0.0)));
  EXPECT_FALSE(may_be_zero(Interval(0x1p-1074, 1.0)));
  EXPECT_FALSE(may_be_zero(Interval(-1.0, -0x1p-1074)));
  EXPECT_TRUE(may_be_zero(Interval(nan)));
}

TEST(IntervalMotion, HoldsThePointsOnTheirWay) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Query query = tests::full_significand_query(random);
    const double from = random.uniform(0.0, 0.9);
    const Interval times(from, from + random.uniform(0.0, 0.1));
    const auto points = IntervalMotion(query).at(times);
    for (const double t : {times.lower(), times.upper()}) {
      for (std::size_t point = 0; point < moving_points; ++point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const Rational start(query.at(0, point, axis));
          const Rational end(query.at(1, point, axis));
          EXPECT_TRUE(holds(points[point][axis], start + Rational(t) * (end - start)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::baselines::intervals_test

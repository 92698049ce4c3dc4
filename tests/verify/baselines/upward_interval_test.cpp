/// \file
/// Intervals contain the results of rationals, over the whole range of doubles.

#include "verify/baselines/upward_interval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"

namespace touchstone::baselines::upward_interval_test {
namespace {

using exact::Rational;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool holds(const UpwardInterval& interval, const Rational& x) {
  if (std::isnan(interval.minus_lower) || std::isnan(interval.upper)) return false;
  return (interval.minus_lower == infinity || Rational(-interval.minus_lower) <= x) &&
         (interval.upper == infinity || x <= Rational(interval.upper));
}

/// The three operations, computed in the upward mode.
[[gnu::noinline]] std::array<UpwardInterval, 4> operations(const UpwardInterval& a,
                                                           const UpwardInterval& b) {
  return {a + b, a - b, a * b, half(a)};
}

std::array<UpwardInterval, 4> rounded_operations(const UpwardInterval& a, const UpwardInterval& b) {
  const UpwardRounding upward;
  return operations(a, b);
}

UpwardInterval from_to(double lower, double upper) { return {-lower, upper}; }

UpwardInterval random_interval(tests::Random& random, bool any_exponent) {
  const auto draw = [&] {
    return any_exponent ? random.finite_double() : random.few_bit_double(53, -53, -50);
  };
  const double a = random.between(0, 7) == 0 ? 0.0 : draw();
  const double b = random.between(0, 3) == 0 ? a : draw();
  return from_to(std::min(a, b), std::max(a, b));
}

TEST(UpwardInterval, HoldsTheResultsOfItsEnds) {
  tests::Random random(2);
  for (int i = 0; i < tests::trials(20000); ++i) {
    const UpwardInterval a = random_interval(random, i % 2 == 0);
    const UpwardInterval b = random_interval(random, i % 2 == 0);
    const auto results = rounded_operations(a, b);
    for (const double x : {-a.minus_lower, a.upper}) {
      for (const double y : {-b.minus_lower, b.upper}) {
        ASSERT_TRUE(holds(results[0], Rational(x) + Rational(y)));
        ASSERT_TRUE(holds(results[1], Rational(x) - Rational(y)));
        ASSERT_TRUE(holds(results[2], Rational(x) * Rational(y)));
      }
      ASSERT_TRUE(holds(results[3], Rational(x) / 2));
    }
  }
}

TEST(UpwardInterval, StandsForFiniteNumbersWhereItsEndsAreInfinite) {
  const UpwardInterval unbounded{infinity, infinity}, zero(0.0);
  const auto product = rounded_operations(unbounded, zero)[2];
  EXPECT_TRUE(is_zero(product));
  const auto of_large = rounded_operations(from_to(1e300, 1e308), from_to(-1e308, 1e300))[2];
  EXPECT_EQ(of_large.minus_lower, infinity);
  EXPECT_EQ(of_large.upper, infinity);
  EXPECT_EQ(of_large.sign(), 0);
}

}  // namespace
}  // namespace touchstone::baselines::upward_interval_test

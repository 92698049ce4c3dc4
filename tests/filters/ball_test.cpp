#include "filters/ball.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::filters::ball_test {
namespace {

using tests::Random;

constexpr double tiniest = std::numeric_limits<double>::denorm_min();

mpq_class exact(const DoubleDouble<double>& x) { return mpq_class(x.high) + mpq_class(x.low); }

/// A ball and a number in it, often at its end.
struct Member {
  Ball ball;
  mpq_class number;
};

double random_double(Random& random, int least_exponent, int greatest_exponent) {
  if (random.between(0, 9) == 0) return 0.0;
  const double x = random.uniform(0.5, 1) * (random.coin() ? 1 : -1);
  const double coarse = random.between(0, 3) == 0 ? std::round(8 * x) / 8 : x;
  return std::ldexp(coarse, random.between(least_exponent, greatest_exponent));
}

Member random_member(Random& random, int least_exponent, int greatest_exponent) {
  const double high = random_double(random, least_exponent, greatest_exponent);
  const double low = high * random_double(random, -60, -54);
  Member result{Ball(exact_sum(high, low)), 0};
  if (random.coin()) {
    result.ball.radius =
        std::abs(random_double(random, least_exponent - 110, greatest_exponent - 40));
  }
  const mpq_class part(random.between(0, 2) == 0 ? 1.0 : random.uniform(0, 1));
  const mpq_class offset = part * mpq_class(result.ball.radius);
  result.number = exact(result.ball.center) + (random.coin() ? offset : mpq_class(-offset));
  return result;
}

bool holds(const Ball& ball, const mpq_class& number) {
  return abs(mpq_class(number - exact(ball.center))) <= mpq_class(ball.radius);
}

TEST(Ball, HoldsSumsDifferencesAndProductsOfItsNumbers) {
  Random random(2100);
  for (int i = 0; i < tests::trials(100'000); ++i) {
    // Similar magnitudes, so that sums cancel; and all magnitudes, subnormal ones too.
    const int exponent = random.coin() ? random.between(-4, 4) : random.between(-1070, 480);
    const Member a = random_member(random, exponent, exponent + 2);
    Member b = random_member(random, exponent, exponent + 2);
    if (random.between(0, 5) == 0) b = {-a.ball, mpq_class(-a.number)};
    ASSERT_TRUE(holds(a.ball + b.ball, a.number + b.number));
    ASSERT_TRUE(holds(a.ball - b.ball, a.number - b.number));
    ASSERT_TRUE(holds(a.ball * b.ball, a.number * b.number));
    ASSERT_TRUE(holds(-a.ball, -a.number));
    ASSERT_TRUE(holds(abs(a.ball), abs(a.number)));
    ASSERT_TRUE(!is_positive(a.ball) || a.number > 0);
  }
}

TEST(Ball, IsNarrow) {
  Random random(2101);
  for (int i = 0; i < tests::trials(10'000); ++i) {
    const Ball a(random.uniform(1, 2)), b(random.uniform(1, 2));
    const Ball c = a * b * a + b * b * a;
    EXPECT_LE(c.radius, 0x1p-98 * c.center.high);
    EXPECT_TRUE(is_positive(c));
    EXPECT_TRUE(is_positive(c - Ball(c.center.high * (1 - 0x1p-51))));
  }
}

TEST(Ball, KeepsZero) {
  const Ball a(0.1), zero(0.0), little(tiniest);
  EXPECT_TRUE(is_exact_zero(a - a));
  EXPECT_TRUE(is_exact_zero(a * zero));
  EXPECT_TRUE(is_exact_zero(zero * a + (a - a)));
  EXPECT_FALSE(is_exact_zero(little * little));
  EXPECT_FALSE(is_positive(little * little));
  EXPECT_FALSE(is_positive(zero));
  EXPECT_TRUE(is_positive(little));
  EXPECT_FALSE(is_positive(a * a - a * a));
}

}  // namespace
}  // namespace touchstone::filters::ball_test

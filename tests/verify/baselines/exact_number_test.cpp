/// \file
/// Exact numbers against rationals, and the scaling of doubles to integers.

#include "verify/baselines/exact_number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"

namespace touchstone::baselines::exact_number_test {
namespace {

using exact::Rational;

TEST(ExactNumber, HasTheSignsOfRationalsOverTheWholeRangeOfDoubles) {
  tests::Random random(3);
  for (int i = 0; i < tests::trials(2000); ++i) {
    std::array<double, 6> values{};
    for (double& x : values) {
      x = i % 2 == 0 ? random.finite_double() : random.few_bit_double(4, -2, 2);
    }
    const auto integers = scaled_to_integers(values);
    std::array<Rational, 6> r;
    for (std::size_t k = 0; k < 6; ++k) r[k] = Rational(values[k]);
    const auto& n = integers;
    EXPECT_EQ((n[0] * n[1] - n[2] * n[3]).sign(), sgn(Rational(r[0] * r[1] - r[2] * r[3])));
    EXPECT_EQ((n[4] + n[5] - n[0]).sign(), sgn(Rational(r[4] + r[5] - r[0])));
    EXPECT_EQ((-n[0]).sign(), -sgn(r[0]));
    EXPECT_EQ(same_sign(n[0], n[1]), sgn(r[0]) == sgn(r[1]));
    EXPECT_EQ(n[0] * n[1] == n[2] * n[3], Rational(r[0] * r[1]) == Rational(r[2] * r[3]));
  }
}

TEST(ExactNumber, CanBeHalvedOnceForADoubling) {
  const auto n = scaled_to_integers(std::array{0.1, -3.0, 0.0}, 1);
  for (const ExactNumber& x : n) EXPECT_TRUE(half(x) + half(x) == x);
  EXPECT_TRUE(is_zero(n[2]));
  EXPECT_FALSE(is_zero(n[0]));
}

TEST(ExactNumber, EstimatesDoubles) {
  tests::Random random(4);
  for (int i = 0; i < tests::trials(2000); ++i) {
    const std::array values{random.finite_double(), random.finite_double()};
    const int exponent = common_exponent(values);
    const auto n = scaled_to_integers(values);
    EXPECT_NEAR(n[0].estimate(exponent) / values[0], 1.0,
                std::abs(values[0]) < 0x1p-1020 ? 1.0 : 0x1p-50);
    const Rational product = Rational(values[0]) * Rational(values[1]);
    const double expected = exact::round_to_nearest(product);
    if (std::abs(expected) < 0x1p1023 && std::abs(expected) > 0x1p-1000) {
      EXPECT_NEAR((n[0] * n[1]).estimate(2L * exponent) / expected, 1.0, 0x1p-48);
    }
  }
  EXPECT_EQ(ExactNumber(0).estimate(5), 0.0);
  EXPECT_EQ(ExactNumber(-3).estimate(2), -12.0);
}

}  // namespace
}  // namespace touchstone::baselines::exact_number_test

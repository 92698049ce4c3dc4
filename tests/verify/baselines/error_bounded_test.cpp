/// \file
/// The bound holds against rationals; and what is left of it when numbers underflow.

#include "verify/baselines/error_bounded.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::baselines::error_bounded_test {
namespace {

using exact::Rational;

/// A number and what it stands for.
struct Pair {
  ErrorBounded number;
  Rational truth;
};

bool holds(const Pair& pair) {
  const Rational error = abs(Rational(pair.number.value) - pair.truth);
  return error <= Rational(pair.number.bound);
}

TEST(ErrorBounded, HoldsTheTruth) {
  tests::Random random(1);
  const auto draw = [&] {
    const double x = random.few_bit_double(53, -56, -50);
    return Pair{x, Rational(x)};
  };
  for (int i = 0; i < tests::trials(4000); ++i) {
    Pair x = draw();
    for (int step = 0; step < 12; ++step) {
      const Pair y = draw();
      switch (random.between(0, 4)) {
        case 0:
          x = {x.number + y.number, Rational(x.truth + y.truth)};
          break;
        case 1:
          x = {x.number - y.number, Rational(x.truth - y.truth)};
          break;
        case 2:
          x = {half(-x.number), Rational(-x.truth / 2)};
          break;
        default:
          x = {x.number * y.number, Rational(x.truth * y.truth)};
          break;
      }
      ASSERT_TRUE(holds(x));
      if (x.number.sign() != 0) {
        ASSERT_EQ(x.number.sign(), sgn(x.truth));
      }
    }
  }
}

TEST(ErrorBounded, SignIsZeroWhereItIsNotCertain) {
  EXPECT_EQ(ErrorBounded(1.0, 0.5).sign(), 1);
  EXPECT_EQ(ErrorBounded(-1.0, 0.5).sign(), -1);
  EXPECT_EQ(ErrorBounded(1.0, 1.0).sign(), 0);
  EXPECT_EQ(ErrorBounded(-1.0, 1.0).sign(), 0);
  EXPECT_EQ(ErrorBounded(0.0).sign(), 0);
  EXPECT_EQ(ErrorBounded(0.1, std::numeric_limits<double>::quiet_NaN()).sign(), 0);
}

TEST(ErrorBounded, ExactInputHasNoBoundAndAnOperationHas) {
  EXPECT_EQ(ErrorBounded(0.1).bound, 0.0);
  EXPECT_EQ((ErrorBounded(0.5) + ErrorBounded(0.25)).bound, 0.75 * ErrorBounded::unit);
  EXPECT_EQ((ErrorBounded(0.5) * ErrorBounded(-0.25)).bound, 0.125 * ErrorBounded::unit);
}

TEST(ErrorBounded, LosesItsBoundBeforeItsValueWhenItUnderflows) {
  // 1 ± 2^-1 is of no certain sign beside 3/4; scaled down, that is forgotten.
  const ErrorBounded about(1.0, 0.5), tiny(0x1p-1074);
  EXPECT_EQ((about - ErrorBounded(0.75)).sign(), 0);
  const ErrorBounded scaled = (about - ErrorBounded(0.75)) * ErrorBounded(0x1p-1072);
  EXPECT_GT(scaled.value, 0.0);
  EXPECT_LT(scaled.bound, 0x1p-1072);  // half of what it should be
  // A product of numbers that are not zero is exactly zero, with no doubt about it.
  EXPECT_EQ((tiny * tiny).value, 0.0);
  EXPECT_EQ((tiny * tiny).bound, 0.0);
}

}  // namespace
}  // namespace touchstone::baselines::error_bounded_test

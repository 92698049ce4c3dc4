/// \file
/// The bound holds against rationals, except after underflow.

#include "verify/baselines/error_bounded.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"

namespace touchstone::baselines::error_bounded_test {
namespace {

using exact::Rational;

/// A number and its exact value.
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

TEST(ErrorBounded, LosesItsBoundBeforeItsValueWhenItUnderflows) {
  // The sign of 1 ± 2^-1 less 3/4 is uncertain; after scaling down, it seems certain.
  const ErrorBounded about(1.0, 0.5), tiny(0x1p-1074);
  EXPECT_EQ((about - ErrorBounded(0.75)).sign(), 0);
  const ErrorBounded scaled = (about - ErrorBounded(0.75)) * ErrorBounded(0x1p-1072);
  EXPECT_GT(scaled.value, 0.0);
  EXPECT_LT(scaled.bound, 0x1p-1072);  // half of the right bound
  // A product of numbers other than zero is exactly zero, with bound 0.
  EXPECT_EQ((tiny * tiny).value, 0.0);
  EXPECT_EQ((tiny * tiny).bound, 0.0);
}

}  // namespace
}  // namespace touchstone::baselines::error_bounded_test

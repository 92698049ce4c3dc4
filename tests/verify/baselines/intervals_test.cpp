/// \file
/// The three arithmetics of the filters of methods against rationals: intervals of two rounding
/// modes, of the upward mode alone, and values with error bounds.

#include "verify/baselines/intervals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/number.hpp"
#include "touchstone/query.hpp"
#include "verify/baselines/error_bounded.hpp"
#include "verify/baselines/upward_interval.hpp"

namespace touchstone::baselines::intervals_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_between(double lower, const Rational& value, double upper) {
  return (lower == -infinity || Rational(lower) <= value) &&
         (upper == infinity || value <= Rational(upper));
}
bool holds(const Interval& x, const Rational& value) {
  return is_between(x.lower(), value, x.upper());
}
bool holds(const UpwardInterval& x, const Rational& value) {
  return is_between(-x.minus_lower, value, x.upper);
}
bool holds(const ErrorBounded& x, const Rational& value) {
  return abs(Rational(x.value) - value) <= Rational(x.bound);
}

int sign_of(const Interval& x) { return may_be_zero(x) ? 0 : x.lower() > 0.0 ? 1 : -1; }
template <class Number>
int sign_of(const Number& x) {
  return x.sign();
}

Interval half(const Interval& x) { return x * Interval(0.5); }

/// Number `operation` of four, in the rounding mode of this moment.
template <class Number>
[[gnu::noinline]] Number result_of(int operation, const Number& a, const Number& b) {
  if (operation == 0) return a + b;
  if (operation == 1) return a - b;
  return operation == 2 ? half(-a) : a * b;
}
Rational exact_result_of(int operation, const Rational& a, const Rational& b) {
  if (operation == 0) return a + b;
  if (operation == 1) return a - b;
  return operation == 2 ? Rational(-a / 2) : Rational(a * b);
}

struct UpwardMode {
  UpwardRounding upward;
};
struct AnyMode {};

/// Random operations, one after the other, on numbers that are ends of make(lower, upper).
template <class Number, class Mode, class Make>
void expect_held(bool of_any_exponent, const Make& make) {
  Random random(2);
  int certain = 0;
  for (int i = 0; i < tests::trials(4000); ++i) {
    const auto draw_double = [&] {
      if (random.between(0, 7) == 0) return 0.0;
      return of_any_exponent && i % 2 == 0 ? random.finite_double()
                                           : random.few_bit_double(53, -56, -50);
    };
    Rational truth;
    const auto draw = [&] {
      const double a = draw_double(), b = random.coin() ? a : draw_double();
      truth = random.coin() ? a : b;
      return make(truth.get_d(), a, b);
    };
    Number x = draw();
    for (int step = 0; step < 6; ++step) {
      const Rational before = truth;
      const Number y = draw();
      const int operation = random.between(0, 3);
      {
        [[maybe_unused]] const Mode mode;
        x = result_of(operation, x, y);
      }
      truth = exact_result_of(operation, before, truth);
      ASSERT_TRUE(holds(x, truth));
      ASSERT_TRUE(sign_of(x) == 0 || sign_of(x) == sgn(truth));
      certain += sign_of(x) == 0 ? 0 : 1;
    }
  }
  EXPECT_GT(certain, tests::trials(4000));
}

TEST(Arithmetic, HoldsTheResultsOfRationals) {
  expect_held<Interval, AnyMode>(
      true, [](double, double a, double b) { return Interval(std::min(a, b), std::max(a, b)); });
  expect_held<UpwardInterval, UpwardMode>(true, [](double, double a, double b) {
    return UpwardInterval(-std::min(a, b), std::max(a, b));
  });
  // (Its bound may be lost when it underflows.)
  expect_held<ErrorBounded, AnyMode>(false, [](double x, double, double) { return x; });
}

/// Operations on two doubles have the narrowest interval of doubles.
TEST(Interval, IsTight) {
  Random random(1);
  int wide = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.few_bit_double(53, -60, 4), y = random.few_bit_double(53, -60, 4);
    for (const int operation : {0, 1, 3}) {
      const Interval found = result_of(operation, Interval(x), Interval(y));
      const Rational truth = exact_result_of(operation, x, y);
      const bool is_exact = found.lower() == found.upper();
      EXPECT_TRUE(holds(found, truth));
      EXPECT_TRUE(is_exact ||
                  (std::nextafter(found.lower(), infinity) == found.upper() &&
                   Rational(found.lower()) != truth && Rational(found.upper()) != truth));
      wide += operation == 3 && !is_exact ? 1 : 0;
    }
  }
  EXPECT_GT(wide, 9000) << "two directions give two numbers";
}

/// NaN excludes nothing.
TEST(Arithmetic, IsCertainOfNoSignWhereItCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Interval& x : {Interval(-1.0, 1.0), {0.0, 1.0}, {-1.0, 0.0}, Interval(nan)}) {
    EXPECT_TRUE(may_be_zero(x));
  }
  EXPECT_FALSE(may_be_zero(Interval(0x1p-1074, 1.0)));
  EXPECT_FALSE(may_be_zero(Interval(-1.0, -0x1p-1074)));
  EXPECT_EQ(ErrorBounded(1.0, 0.5).sign(), 1);
  EXPECT_EQ(ErrorBounded(-1.0, 0.5).sign(), -1);
  for (const ErrorBounded& x : {ErrorBounded(1.0, 1.0), {-1.0, 1.0}, {0.0, 0.0}, {0.1, nan}}) {
    EXPECT_EQ(x.sign(), 0);
  }
  EXPECT_TRUE(is_zero(UpwardInterval(infinity, infinity) * UpwardInterval(0.0)));
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
          const Rational start(query.at(0, point, axis)), end(query.at(1, point, axis));
          EXPECT_TRUE(holds(points[point][axis], start + Rational(t) * (end - start)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::baselines::intervals_test

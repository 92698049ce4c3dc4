#include "touchstone/filters/separation_expressions.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "tests/filters/support.hpp"

namespace touchstone::filters::separation_expressions_test {
namespace {

constexpr int trials = 200;

TEST(SeparationExpressions, GapIsHowFarACornerIsBeyondTheDistance) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const RationalVector d = random.vector();
    const auto [a0, a1] = random.motion();
    const auto [b0, b1] = random.motion();
    const mpq_class n = random.number(), distance = random.number(), t = random.fraction();
    const std::array<mpq_class, 17> x{d[0],  d[1],  d[2],  n,     a0[0],   a0[1],
                                      a0[2], b0[0], b0[1], b0[2], a1[0],   a1[1],
                                      a1[2], b1[0], b1[1], b1[2], distance};
    const RationalVector a = RationalMotion{a0, a1}.at(t), b = RationalMotion{b0, b1}.at(t);
    const mpq_class expected = dot(d, a) - dot(d, b) - n * distance;
    EXPECT_EQ(AdvancedGap::evaluate<mpq_class>(x, {1 - t, t}), expected);
    std::array<mpq_class, 19> ones;
    std::ranges::fill(ones, mpq_class(1));
    ones[0] = 1 - t;
    ones[1] = t;
    EXPECT_EQ(MeasuredAdvancedGap::evaluate<mpq_class>(x, ones), expected);
    EXPECT_EQ(CornerGap::evaluate<mpq_class>({d[0], d[1], d[2], n, a[0], a[1], a[2], distance}, {}),
              dot(d, a) - n * distance);
  }
}

TEST(SeparationExpressions, LengthsAreThoseOfTheNorms) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const RationalVector x = random.vector();
    const mpq_class distance = random.number();
    const mpq_class square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    EXPECT_EQ(ComponentSum::evaluate<mpq_class>(x, {}), x[0] + x[1] + x[2]);
    EXPECT_EQ(SquaredLength::evaluate<mpq_class>(x, {}), square);
    EXPECT_EQ(LengthDefect::evaluate<mpq_class>({x[0], x[1], x[2], distance}, {}),
              distance * distance - square);
  }
}

TEST(SeparationExpressions, ContactComponentIsFBeyondTheDistance) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const auto [start, end] = random.motion();  // r, p, q on one axis
    const mpq_class t = random.fraction(), u = random.fraction(), v = random.fraction();
    const mpq_class distance = random.number();
    const RationalVector now = RationalMotion{start, end}.at(t);
    EXPECT_EQ(
        ContactComponent::evaluate<mpq_class>(
            {start[0], start[1], start[2], end[0], end[1], end[2], distance}, {1 - t, t, u, v}),
        now[0] - u * now[1] - v * now[2] - distance);
  }
}

}  // namespace
}  // namespace touchstone::filters::separation_expressions_test

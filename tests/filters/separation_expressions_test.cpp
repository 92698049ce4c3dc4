#include "touchstone/filters/separation_expressions.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>

namespace touchstone::filters::separation_expressions_test {
namespace {

using Vector = Vector3<mpq_class>;

/// Tests with small rationals: all is exact.
class SeparationExpressions : public ::testing::Test {
 protected:
  static constexpr int trials = 200;

  mpq_class number() {
    return mpq_class(static_cast<int>(random_() % 41) - 20) / (1 + static_cast<int>(random_() % 7));
  }
  mpq_class fraction() { return mpq_class(static_cast<int>(random_() % 9)) / 8; }
  Vector vector() { return {number(), number(), number()}; }

  static Vector at(const Vector& start, const Vector& end, const mpq_class& t) {
    Vector result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = start[i] + t * (end[i] - start[i]);
    return result;
  }

 private:
  std::mt19937_64 random_{3};
};

TEST_F(SeparationExpressions, GapIsHowFarACornerIsBeyondTheDistance) {
  for (int i = 0; i < trials; ++i) {
    const Vector d = vector(), a0 = vector(), b0 = vector(), a1 = vector(), b1 = vector();
    const mpq_class n = number(), distance = number(), t = fraction();
    const std::array<mpq_class, 17> x{d[0],  d[1],  d[2],  n,     a0[0],   a0[1],
                                      a0[2], b0[0], b0[1], b0[2], a1[0],   a1[1],
                                      a1[2], b1[0], b1[1], b1[2], distance};
    const Vector a = at(a0, a1, t), b = at(b0, b1, t);
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

TEST_F(SeparationExpressions, LengthsAreThoseOfTheNorms) {
  for (int i = 0; i < trials; ++i) {
    const Vector x = vector();
    const mpq_class distance = number();
    const mpq_class square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    EXPECT_EQ(ComponentSum::evaluate<mpq_class>(x, {}), x[0] + x[1] + x[2]);
    EXPECT_EQ(SquaredLength::evaluate<mpq_class>(x, {}), square);
    EXPECT_EQ(LengthDefect::evaluate<mpq_class>({x[0], x[1], x[2], distance}, {}),
              distance * distance - square);
  }
}

TEST_F(SeparationExpressions, ContactComponentIsFBeyondTheDistance) {
  for (int i = 0; i < trials; ++i) {
    const Vector start = vector(), end = vector();
    const mpq_class t = fraction(), u = fraction(), v = fraction(), distance = number();
    const Vector now = at(start, end, t);  // r, p, q on one axis
    EXPECT_EQ(
        ContactComponent::evaluate<mpq_class>(
            {start[0], start[1], start[2], end[0], end[1], end[2], distance}, {1 - t, t, u, v}),
        now[0] - u * now[1] - v * now[2] - distance);
  }
}

}  // namespace
}  // namespace touchstone::filters::separation_expressions_test

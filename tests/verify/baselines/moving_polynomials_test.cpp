#include "verify/baselines/moving_polynomials.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::baselines::moving_polynomials_test {
namespace {

using tests::Random;

/// Polynomials of integer coefficients, so that sums and products are exact.
template <std::size_t Degree>
Polynomial<Degree> draw(Random& random) {
  Polynomial<Degree> result;
  for (double& c : result.c) c = random.between(-20, 20);
  return result;
}

TEST(Polynomial, HasTheValueOfItsPowers) {
  const Polynomial<3> p{{5.0, -3.0, 0.0, 2.0}};
  EXPECT_EQ(p(0.0), 5.0);
  EXPECT_EQ(p(2.0), 5.0 - 6.0 + 16.0);
  EXPECT_EQ(Polynomial<0>{{7.0}}(3.0), 7.0);
}

TEST(Polynomial, OperationsAreThoseOfTheValues) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto a = draw<3>(random);
    const auto b = draw<2>(random);
    const double t = random.between(-4, 4);
    EXPECT_EQ((a + b)(t), a(t) + b(t));
    EXPECT_EQ((b + a)(t), a(t) + b(t));
    EXPECT_EQ((a - b)(t), a(t) - b(t));
    EXPECT_EQ((b - a)(t), b(t) - a(t));
    EXPECT_EQ((a * b)(t), a(t) * b(t));
    EXPECT_EQ((3.0 * a)(t), 3.0 * a(t));
  }
}

TEST(VectorPolynomial, OperationsAreThoseOfTheValues) {
  Random random(2);
  const auto value = [](const auto& a, double t) {
    return Eigen::Vector3d(a[0](t), a[1](t), a[2](t));
  };
  for (int i = 0; i < 1000; ++i) {
    const VectorPolynomial<1> a{draw<1>(random), draw<1>(random), draw<1>(random)};
    const VectorPolynomial<2> b{draw<2>(random), draw<2>(random), draw<2>(random)};
    const double t = random.between(-4, 4);
    EXPECT_EQ(value(a - b, t), value(a, t) - value(b, t));
    EXPECT_EQ(value(cross(a, b), t), value(a, t).cross(value(b, t)));
    EXPECT_EQ(dot(a, b)(t), value(a, t).dot(value(b, t)));
    EXPECT_EQ(squared_norm(b)(t), value(b, t).squaredNorm());
  }
}

TEST(LinearMotion, IsWhereThePointsAre) {
  const Query query = tests::over_triangle(1, 2, 3, -1).query;
  const auto motions = motions_of(query);
  EXPECT_EQ(motions[0][2](0.0), 3.0);
  EXPECT_EQ(motions[0][2](0.25), 2.0);
  EXPECT_EQ(motions[0][2](1.0), -1.0);
  EXPECT_EQ(motions[2][0](0.5), 4.0);
  EXPECT_EQ(motion_of(query, 3)[1](0.5), 4.0);
}

TEST(Coefficients, DescendWithoutLeadingZeros) {
  const auto coefficients = descending(Polynomial<4>{{0.0, 1.0, 2.0, 0.0, -0.0}});
  EXPECT_EQ(coefficients, (std::array<double, 5>{0.0, 0.0, 2.0, 1.0, 0.0}));
  const auto left = without_leading_zeros(coefficients);
  ASSERT_EQ(left.size(), 3U);
  EXPECT_EQ(left[0], 2.0);
  EXPECT_TRUE(without_leading_zeros(descending(Polynomial<6>{})).empty());
  const std::array<double, 2> tiny{0x1p-1074, 1.0};
  EXPECT_EQ(without_leading_zeros(tiny).size(), 2U) << "tiny is not 0";
}

}  // namespace
}  // namespace touchstone::baselines::moving_polynomials_test

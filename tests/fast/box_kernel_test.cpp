/// \file
/// The kernels against the expressions that they state, bit for bit, and against each other.

#include "fast/tight_inclusion/box_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "touchstone/filters/expressions.hpp"

namespace touchstone::fast::box_kernel_test {
namespace {

using tests::Random;

/// A dyadic interval within [0,1], of a width down to 2^-digits.
std::array<double, 2> random_interval(Random& random, int digits) {
  const int depth = random.between(0, digits);
  const double width = std::ldexp(1.0, -depth);
  const double lower = std::floor(random.uniform() / width) * width;
  return {lower, lower + width};
}

Box random_box(Random& random, int digits) {
  const auto t = random_interval(random, digits), u = random_interval(random, digits),
             v = random_interval(random, digits);
  return {{t[0], t[1], u[0], u[1], v[0], v[1]}};
}

Query random_query(Random& random) {
  constexpr std::array exponents{-1060, -30, 0, 1, 40, 1000};
  const int exponent = exponents[static_cast<std::size_t>(random.between(0, 5))];
  Query query{};
  for (double& x : query.coordinates) {
    x = std::ldexp(random.uniform(-1.0, 1.0), exponent - random.between(0, 3));
    if (random.between(0, 20) == 0) x = random.coin() ? 0.0 : -0.0;
  }
  return query;
}

/// F at corner number `corner` (binary digits t, u, v), from the kernel's stated expressions.
double expression(const BoxProblem& problem, const Box& box, std::size_t axis, std::size_t corner) {
  const std::array<double, 8>& x = problem.coordinates[axis];
  const std::size_t late = corner / 4, far_u = corner / 2 % 2, far_v = corner % 2;
  const double t = box.ends[late], u = box.ends[2 + far_u], v = box.ends[4 + far_v];
  if (problem.kind == ContactKind::edge_edge) {
    return filters::EdgeEdge::evaluate<double>(x, {1.0 - t, t, 1.0 - u, u, 1.0 - v, v});
  }
  return filters::VertexFace::evaluate<double>(x, {1.0 - t, t, 1.0 - u - v, u, v});
}

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

class EachKernel : public testing::TestWithParam<const BoxKernel*> {};

INSTANTIATE_TEST_SUITE_P(All, EachKernel, testing::ValuesIn(box_kernels()), [](const auto& tested) {
  return std::string(to_string(tested.param->instructions));
});

TEST_P(EachKernel, LoadsCoordinatesAndTheirExtent) {
  Random random(1);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Query query = random_query(random);
  BoxProblem problem;
  EXPECT_TRUE(GetParam()->load(query, problem).finite);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_EQ(bits(problem.coordinates[i % 3][i / 3]), bits(query.coordinates[i]));
  }
  for (std::size_t i = 0; i < 24; ++i) {
    Query other{};
    std::array<double, 3> expected{};
    expected[i % 3] = 3.0;
    for (const double x : {-3.0, 3.0}) {
      other.coordinates[i] = x;
      EXPECT_EQ(GetParam()->load(other, problem).x_max, expected);
    }
    for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
      other.coordinates[i] = bad;
      EXPECT_FALSE(GetParam()->load(other, problem).finite) << i << ' ' << bad;
    }
  }
}

TEST_P(EachKernel, ComputesTheExpressionsBitForBitAndTestsTheBoxOfItsCorners) {
  const BoxKernel& kernel = *GetParam();
  Random random(2);
  int rejections = 0, insides = 0;
  for (int i = 0; i < 20000; ++i) {
    BoxProblem problem;
    problem.kind = random.coin() ? ContactKind::edge_edge : ContactKind::vertex_face;
    const Query query = random_query(random);
    const Box box = random_box(random, kernel.digits);
    static_cast<void>(kernel.load(query, problem));
    const auto tolerance = [&] {
      return std::abs(query.coordinates[0]) * random.uniform(0.0, 4.0);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) problem.filter[axis] = tolerance();
    problem.separation = random.coin() ? 0.0 : tolerance();

    bool rejected = false, inside = true;
    double width = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CornerValues values = kernel.corners(problem, box, axis);
      for (std::size_t corner = 0; corner < 8; ++corner) {
        ASSERT_EQ(bits(values[corner]), bits(expression(problem, box, axis, corner)))
            << to_string(problem.kind) << " case " << i << " axis " << axis << " corner " << corner;
      }
      const auto [least, greatest] = std::ranges::minmax(values);
      const double filter = problem.filter[axis], d = problem.separation;
      rejected = rejected || least - d > filter || greatest + d < -filter;
      inside = inside && greatest - d <= filter && least + d >= -filter;
      width = std::max(width, greatest - least);
    }
    const BoxTest test = kernel.test(problem, box);
    ASSERT_EQ(test.rejected, rejected) << i;
    rejections += rejected ? 1 : 0;
    if (rejected) continue;
    ASSERT_EQ(test.inside, inside) << i;
    ASSERT_EQ(test.width, width) << i;
    insides += inside ? 1 : 0;
  }
  EXPECT_GT(rejections, 1000);
  EXPECT_GT(insides, 1000);
}

}  // namespace
}  // namespace touchstone::fast::box_kernel_test

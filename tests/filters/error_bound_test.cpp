#include "touchstone/filters/error_bound.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace touchstone::filters::error_bound_test {
namespace {

TEST(ErrorBound, IsAPolynomialInTheGreatestCoordinate) {
  static constexpr ErrorBound<double, 1> linear{.coefficients = {{0.5, 3}}, .greatest_x = 8};
  static_assert(linear(0) == 0.5 && linear(2) == 6.5 && linear(8) == 24.5);
  static constexpr ErrorBound<float, 2> quadratic{.coefficients = {{1, 2, 3}}, .greatest_x = 8};
  static_assert(quadratic(0) == 1 && quadratic(1) == 6 && quadratic(2) == 17);
  EXPECT_EQ(quadratic(-1.0F * -2.0F), 17.0F);
}

TEST(ErrorBound, KeepsUnderflowWhereRoundingVanishes) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  constexpr ErrorBound<double, 1> bound{.coefficients = {{6 * least, 0x1p-50}}, .greatest_x = 1};
  EXPECT_EQ(bound(0), 6 * least);
  EXPECT_EQ(bound(least), 6 * least);
}

}  // namespace
}  // namespace touchstone::filters::error_bound_test

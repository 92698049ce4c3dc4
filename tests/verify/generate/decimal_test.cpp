#include "verify/generate/everyday.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace touchstone::verify::generate::decimal_test {
namespace {

TEST(ShortestDecimal, IsTheUsualNotation) {
  const auto expect = [](double x, std::uint64_t digits, int count, int exponent) {
    const Decimal decimal = shortest_decimal(x);
    EXPECT_EQ(decimal.digits, digits) << x;
    EXPECT_EQ(decimal.count, count) << x;
    EXPECT_EQ(decimal.exponent, exponent) << x;
    EXPECT_EQ(from_decimal(decimal.digits, decimal.exponent), x);
  };
  expect(0.1, 1, 1, -1);
  expect(0.25, 25, 2, -2);
  expect(300.0, 3, 1, 2);
  expect(0.1 + 0.2, 30000000000000004, 17, -17);
  expect(std::numeric_limits<double>::denorm_min(), 5, 1, -324);
  expect(std::numeric_limits<double>::max(), 17976931348623157, 17, 292);
}

}  // namespace
}  // namespace touchstone::verify::generate::decimal_test

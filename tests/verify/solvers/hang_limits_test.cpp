#include "verify/solvers/hang_limits.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::solvers::hang_limits_test {
namespace {

TEST(HangLimits, ShrinkAfterThreeHangsAndEndTheirSort) {
  HangLimits limits(10.0);
  for (int hang = 0; hang < 6; ++hang) {
    EXPECT_EQ(limits.seconds(), hang < 3 ? 10.0 : 1.0) << hang;
    EXPECT_EQ(limits.is_over("a"), hang >= 5) << hang;
    limits.add(hang % 2 == 0 ? "a" : "b");
  }
  EXPECT_FALSE(limits.is_over("c"));
  EXPECT_EQ(HangLimits(0.0).seconds(), 0.0);
}

/// A sort at which every query hangs costs a logarithmic number of hangs.
TEST(HangLimits, AskFewOfASortThatAlwaysHangs) {
  HangLimits limits(1.0);
  int asked = 0;
  for (int i = 0; i < 100'000; ++i) {
    if (limits.leaves_out("a")) continue;
    ++asked;
    limits.add("a");
  }
  EXPECT_GT(asked, 3 * 10);
  EXPECT_LT(asked, 3 * 18);
}

}  // namespace
}  // namespace touchstone::verify::solvers::hang_limits_test

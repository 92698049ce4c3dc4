#include "verify/solvers/hang_limits.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::solvers::hang_limits_test {
namespace {

TEST(HangLimits, ShrinkAfterThreeAndAfterThirtyHangs) {
  HangLimits limits(10.0);
  for (int hang = 0; hang < 40; ++hang) {
    EXPECT_EQ(limits.seconds(), hang < 3 ? 10.0 : hang < 30 ? 1.0 : 0.1) << hang;
    limits.add(hang % 2 == 0 ? "a" : "b");
  }
}

TEST(HangLimits, SampleTheSortThatHangsAlone) {
  HangLimits limits(1.0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(limits.asks_all("a"));
    EXPECT_FALSE(limits.leaves_out("a"));
    limits.add("a");
  }
  EXPECT_FALSE(limits.asks_all("a"));
  EXPECT_TRUE(limits.asks_all("b"));
  int asked = 0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(limits.leaves_out("b"));
    asked += limits.leaves_out("a") ? 0 : 1;
  }
  EXPECT_EQ(asked, 50);
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

#include "verify/base/deadline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::verify::base::deadline_test {
namespace {

TEST(Deadline, IsNeverOverWithoutALimit) {
  const Deadline never;
  EXPECT_FALSE(never.is_over());
  EXPECT_TRUE(std::isinf(never.seconds_left()));
  EXPECT_TRUE(std::isinf(never.at_least(5.0).seconds_left()));
  EXPECT_TRUE(Deadline(HUGE_VAL).seconds_left() == HUGE_VAL);
}

TEST(Deadline, FollowsItsClock) {
  double now = 100.0;
  const Deadline deadline(8.0, [&now] { return now; });
  EXPECT_EQ(deadline.seconds_left(), 8.0);
  now = 107.0;
  EXPECT_EQ(deadline.seconds_left(), 1.0);
  EXPECT_FALSE(deadline.is_over());
  now = 108.0;
  EXPECT_TRUE(deadline.is_over());
  now = 200.0;
  EXPECT_EQ(deadline.seconds_left(), 0.0);
  EXPECT_TRUE(deadline.is_over());
}

TEST(Deadline, IsMovedFromNowOn) {
  double now = 0.0;
  const Deadline deadline(8.0, [&now] { return now; });
  now = 5.0;
  EXPECT_EQ(deadline.at_most(2.0).seconds_left(), 2.0);
  EXPECT_EQ(deadline.at_most(4.0).seconds_left(), 3.0);
  EXPECT_EQ(deadline.at_least(2.0).seconds_left(), 3.0);
  EXPECT_EQ(deadline.at_least(4.0).seconds_left(), 4.0);
  now = 20.0;
  EXPECT_TRUE(deadline.at_most(4.0).is_over());
  EXPECT_EQ(deadline.at_least(1.0).seconds_left(), 1.0);
}

}  // namespace
}  // namespace touchstone::verify::base::deadline_test

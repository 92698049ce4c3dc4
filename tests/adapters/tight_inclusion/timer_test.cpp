#include "tight_inclusion/timer.hpp"

#include <gtest/gtest.h>

#include <tight_inclusion/timer.hpp>

namespace touchstone::adapters::timer_test {
namespace {

TEST(TightInclusionTimer, StandsAfterItsStop) {
  ticcd::Timer timer;
  EXPECT_EQ(timer.getElapsedTime(), 0.0);
  timer.start();
  const double first = timer.getElapsedTimeInMicroSec();
  EXPECT_GE(timer.getElapsedTimeInMicroSec(), first);
  timer.stop();
  const double seconds = timer.getElapsedTime();
  EXPECT_GE(1e6 * seconds, 0.999 * first);
  EXPECT_EQ(timer.getElapsedTimeInSec(), seconds);
  EXPECT_NEAR(timer.getElapsedTimeInMilliSec(), 1e3 * seconds, 1e-9 * seconds);
  EXPECT_NEAR(timer.getElapsedTimeInMicroSec(), 1e6 * seconds, 1e-6 * seconds);
}

TEST(TightInclusionTimer, AddsItsLifeTimeOnce) {
  double total = 1.0;
  {
    TIGHT_INCLUSION_SCOPED_TIMER(total);
    ticcd::ScopedTimer timer(total);
    while (timer.getElapsedTimeInMicroSec() == 0.0) {
    }
    timer.stop();
    EXPECT_EQ(total, 1.0 + timer.getElapsedTimeInMicroSec());
  }
  EXPECT_GT(total, 1.0);
}

}  // namespace
}  // namespace touchstone::adapters::timer_test

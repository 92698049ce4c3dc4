#include "fast/platform/threads.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <cfenv>

namespace touchstone::fast {
namespace {

TEST(WithThreads, ReturnsWhatTheWorkReturns) {
  EXPECT_EQ(with_threads(1, [] { return 7; }), 7);
}

TEST(WithThreads, AllowsNoMoreThanAskedFor) {
  const auto threads = [] { return oneapi::tbb::this_task_arena::max_concurrency(); };
  EXPECT_EQ(with_threads(1, threads), 1);
  EXPECT_EQ(with_threads(0, threads), oneapi::tbb::info::default_concurrency());
  EXPECT_LE(with_threads(1000, threads), oneapi::tbb::info::default_concurrency());
}

TEST(WithThreads, RoundsToNearestInside) {
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  const auto sum = [] {
    volatile double one = 1.0;
    return one + 0x1p-60;
  };
  const double inside = with_threads(0, sum), after = sum();
  ASSERT_EQ(std::fesetround(FE_TONEAREST), 0);
  EXPECT_EQ(inside, 1.0);
  EXPECT_GT(after, 1.0);
}

}  // namespace
}  // namespace touchstone::fast

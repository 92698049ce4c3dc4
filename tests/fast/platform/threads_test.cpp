#include "fast/platform/threads.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

namespace touchstone::fast {
namespace {

TEST(WithThreads, AllowsNoMoreThanAskedFor) {
  const auto threads = [] { return oneapi::tbb::this_task_arena::max_concurrency(); };
  EXPECT_EQ(with_threads(1, threads), 1);
  EXPECT_EQ(with_threads(0, threads), oneapi::tbb::info::default_concurrency());
  EXPECT_LE(with_threads(1000, threads), oneapi::tbb::info::default_concurrency());
}

}  // namespace
}  // namespace touchstone::fast

#include "verify/base/thread_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace touchstone::verify::base::thread_clock_test {
namespace {

using namespace std::chrono_literals;

TEST(ThreadClock, CountsWorkInNanosecondsAndNoSleep) {
  const auto wall_start = std::chrono::steady_clock::now();
  const double start = thread_nanoseconds();
  while (thread_nanoseconds() < start + 20e6) continue;
  EXPECT_GE(std::chrono::steady_clock::now() - wall_start, 19ms) << "20e6 is 20 ms";
  const double before_sleep = thread_nanoseconds();
  std::this_thread::sleep_for(100ms);
  EXPECT_LT(thread_nanoseconds() - before_sleep, 50e6);
}

TEST(ThreadClock, IsTheThreadsOwn) {
  std::thread worker([] {
    const double start = thread_nanoseconds();
    while (thread_nanoseconds() < start + 100e6) continue;
  });
  const double start = thread_nanoseconds();
  worker.join();
  EXPECT_LT(thread_nanoseconds() - start, 50e6);
}

TEST(ProcessClock, CountsAllThreads) {
  const double start = process_seconds();
  std::thread worker([] {
    const double own_start = thread_nanoseconds();
    while (thread_nanoseconds() < own_start + 20e6) continue;
  });
  worker.join();
  EXPECT_GE(process_seconds() - start, 0.02);
}

}  // namespace
}  // namespace touchstone::verify::base::thread_clock_test

#include "verify/terminal.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace touchstone::verify {
namespace {

TEST(Terminal, ProgressLineShowsBarPercentageAndTimeLeft) {
  EXPECT_EQ(progress_line("reading", 0.5, 10.0),
            "reading [###############...............]  50 %, 10 s left");
  EXPECT_EQ(progress_line("x", 1.0, 3.0), "x [##############################] 100 %, 0 s left");
}

TEST(Terminal, ProgressLineKeepsToItsBounds) {
  EXPECT_EQ(progress_line("x", 0.0, 3.0), "x [..............................]   0 %");
  EXPECT_EQ(progress_line("x", -1.0, 3.0), progress_line("x", 0.0, 3.0));
  EXPECT_EQ(progress_line("x", 2.0, 3.0), progress_line("x", 1.0, 3.0));
}

TEST(Terminal, ProgressBarIsSilentWhereThereIsNoTerminal) {
  using namespace std::chrono_literals;
  ::testing::internal::CaptureStderr();
  {
    ProgressBar bar("silent");
    std::this_thread::sleep_for(1100ms);
    bar.update(0.5);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Terminal, FirstInterruptSetsTheFlagSecondOneEndsTheProcess) {
  const auto interrupt_twice = [] {
    const std::atomic<bool>& flag = interrupted();
    if (flag) _exit(2);
    std::raise(SIGINT);
    if (!flag) _exit(3);
    std::this_thread::sleep_for(std::chrono::milliseconds(same_interrupt_milliseconds + 1));
    std::raise(SIGINT);
    _exit(4);
  };
  EXPECT_EXIT(interrupt_twice(), ::testing::KilledBySignal(SIGINT), "");
}

TEST(Terminal, InterruptsAtOnceAreOne) {
  const auto interrupt_thrice = [] {
    const std::atomic<bool>& flag = interrupted();
    for (int i = 0; i < 3; ++i) std::raise(i == 1 ? SIGTERM : SIGINT);
    _exit(flag ? 0 : 1);
  };
  EXPECT_EXIT(interrupt_thrice(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace touchstone::verify

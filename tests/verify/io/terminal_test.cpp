#include "verify/io/terminal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace touchstone::verify::io::terminal_test {
namespace {

using namespace std::chrono_literals;

TEST(Terminal, ProgressLineShowsBarPercentageAndTimeLeft) {
  EXPECT_EQ(progress_line("reading", 0.5, 10.0),
            "reading [###############...............]  50 %, 10 s left");
  EXPECT_EQ(progress_line("x", 1.0, 3.0), "x [##############################] 100 %, 0 s left");
  EXPECT_EQ(progress_line("x", 0.0, 3.0), "x [..............................]   0 %");
  EXPECT_EQ(progress_line("x", -1.0, 3.0), progress_line("x", 0.0, 3.0));
  EXPECT_EQ(progress_line("x", 2.0, 3.0), progress_line("x", 1.0, 3.0));
}

TEST(Terminal, ProgressBarIsSilentWhereThereIsNoTerminal) {
  ::testing::internal::CaptureStderr();
  {
    ProgressBar bar("silent");
    std::this_thread::sleep_for(1100ms);
    bar.update(0.5);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Terminal, AnInterruptSetsTheFlagAndTheSecondOneOfTheKeysEndsTheProcess) {
  const auto raise_twice = [](int signal) {
    const std::atomic<bool>& flag = interrupted();
    if (flag) _exit(2);
    std::raise(signal);
    if (!flag) _exit(3);
    std::raise(signal);
    _exit(0);
  };
  EXPECT_EXIT(raise_twice(SIGINT), ::testing::KilledBySignal(SIGINT), "");
  // Each of these may come twice at once.
  EXPECT_EXIT(raise_twice(SIGTERM), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(raise_twice(SIGHUP), ::testing::ExitedWithCode(0), "");
}

TEST(Terminal, AnIgnoredHangupStaysIgnored) {
  const auto hang_up = [] {
    std::signal(SIGHUP, SIG_IGN);
    const std::atomic<bool>& flag = interrupted();
    std::raise(SIGHUP);
    _exit(flag ? 1 : 0);
  };
  EXPECT_EXIT(hang_up(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace touchstone::verify::io::terminal_test

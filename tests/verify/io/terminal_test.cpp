#include "verify/io/terminal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
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

/// The clock of a process whose signals are all raised at this time.
std::atomic<std::int64_t> time_of_signals = 1;
std::int64_t clock_of_signals() { return time_of_signals; }

TEST(Terminal, FirstInterruptSetsTheFlagSecondOneEndsTheProcess) {
  const auto interrupt_twice = [](int signal) {
    set_interrupt_clock(clock_of_signals);
    const std::atomic<bool>& flag = interrupted();
    if (flag) _exit(2);
    std::raise(signal);
    if (!flag) _exit(3);
    time_of_signals += same_interrupt_milliseconds;
    std::raise(signal);
    _exit(4);
  };
  EXPECT_EXIT(interrupt_twice(SIGINT), ::testing::KilledBySignal(SIGINT), "");
  EXPECT_EXIT(interrupt_twice(SIGTERM), ::testing::KilledBySignal(SIGTERM), "");
  EXPECT_EXIT(interrupt_twice(SIGHUP), ::testing::KilledBySignal(SIGHUP), "");
}

TEST(Terminal, InterruptsAtOnceAreOne) {
  const auto interrupt_thrice = [] {
    set_interrupt_clock(clock_of_signals);
    const std::atomic<bool>& flag = interrupted();
    for (int i = 0; i < 3; ++i) std::raise(i == 1 ? SIGTERM : SIGINT);
    time_of_signals += same_interrupt_milliseconds - 1;
    std::raise(SIGINT);
    _exit(flag ? 0 : 1);
  };
  EXPECT_EXIT(interrupt_thrice(), ::testing::ExitedWithCode(0), "");
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

TEST(WaitForInput, EndsWithAnInterrupt) {
  const auto interrupt = [] {
    static_cast<void>(interrupted());
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) _exit(2);
    std::thread(std::raise, SIGINT).detach();  // before or during the wait, in another thread
    try {
      wait_for_input(pipe[0]);
    } catch (const Interrupted&) {
      _exit(0);
    }
    _exit(1);
  };
  EXPECT_EXIT(interrupt(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace touchstone::verify::io::terminal_test

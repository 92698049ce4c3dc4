#include "verify/io/terminal.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/support/folder_test.hpp"

namespace touchstone::verify::io::terminal_test {
namespace {

using namespace std::chrono_literals;

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

// ---- Waiting for input --------------------------------------------------------------------------

/// The ends of a pipe.
struct Pipe {
  Pipe() { [[maybe_unused]] const int result = ::pipe(ends.data()); }

  [[nodiscard]] int reader() const { return ends[0]; }
  [[nodiscard]] int writer() const { return ends[1]; }

  std::array<int, 2> ends{-1, -1};
};

TEST(WaitForInput, EndsWhenThereIsSomethingOrTheEnd) {
  const Pipe pipe;
  ASSERT_EQ(::write(pipe.writer(), "x", 1), 1);
  wait_for_input(pipe.reader());
  char byte = 0;
  ASSERT_EQ(::read(pipe.reader(), &byte, 1), 1);
  ::close(pipe.writer());
  wait_for_input(pipe.reader());
  ::close(pipe.reader());
}

TEST(WaitForInput, EndsWithAnInterrupt) {
  const auto interrupt = [] {
    static_cast<void>(interrupted());
    const Pipe pipe;
    std::thread(std::raise, SIGINT).detach();  // before or during the wait, in another thread
    try {
      wait_for_input(pipe.reader());
    } catch (const Interrupted&) {
      _exit(0);
    }
    _exit(1);
  };
  EXPECT_EXIT(interrupt(), ::testing::ExitedWithCode(0), "");
}

// ---- Printing -----------------------------------------------------------------------------------

/// Prints to this descriptor as standard output; exits with 0 if finish_printing() finds no fault.
[[noreturn]] void print_on(int descriptor) {
  std::signal(SIGPIPE, SIG_IGN);
  ::dup2(descriptor, STDOUT_FILENO);
  for (int i = 0; i < 10'000; ++i) print(stdout, "a line that is printed\n");
  try {
    finish_printing();
  } catch (const std::runtime_error& error) {
    print(stderr, error.what());
    _exit(1);
  }
  _exit(0);
}

TEST(Print, EndsWhereTheReaderHasGone) {
  const Pipe pipe;
  ::close(pipe.reader());
  EXPECT_EXIT(print_on(pipe.writer()), ::testing::ExitedWithCode(0), "");
  ::close(pipe.writer());
}

TEST(Print, SaysThatADiskIsFullAndGoesOnUntilThen) {
  const int full = ::open("/dev/full", O_WRONLY);
  EXPECT_EXIT(print_on(full), ::testing::ExitedWithCode(1),
              "standard output: cannot be written: No space left on device");
  ::close(full);
}

using PrintToFile = tests::FolderTest;

TEST_F(PrintToFile, WritesAllOfIt) {
  const auto print_to_file = [this] {
    print_on(::open(path("out").c_str(), O_WRONLY | O_CREAT, 0600));
  };
  EXPECT_EXIT(print_to_file(), ::testing::ExitedWithCode(0), "");
  EXPECT_EQ(read("out").size(), 10'000 * std::string("a line that is printed\n").size());
}

}  // namespace
}  // namespace touchstone::verify::io::terminal_test

#include "verify/io/terminal.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
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

/// Until the thread sleeps in the system: it can do so nowhere but in the wait that it is in.
void wait_until_asleep(pid_t thread) {
  const std::string path = "/proc/self/task/" + std::to_string(thread) + "/stat";
  for (;;) {
    std::ifstream file(path);
    std::string number, name, state;
    if (file >> number >> name >> state && state == "S") return;
    std::this_thread::yield();
  }
}

/// Exits with 0 if an interrupt by this signal ends the wait, whether it comes before or within.
[[noreturn]] void interrupt(int signal, const std::function<void()>& wait) {
  static_cast<void>(interrupted());
  std::atomic<pid_t> thread = 0;
  std::atomic<int> ended = 0;
  std::thread waiting([&] {
    // Signals go to the other thread: only the descriptor can wake this one.
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    thread = ::gettid();
    try {
      wait();
    } catch (const Interrupted&) {
      ++ended;
    }
  });
  while (thread == 0) std::this_thread::yield();
  wait_until_asleep(thread);
  std::raise(signal);
  waiting.join();
  try {
    wait();
  } catch (const Interrupted&) {
    ++ended;
  }
  _exit(ended == 2 ? 0 : 1);
}

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
  const Pipe pipe;
  const auto wait = [&pipe] { wait_for_input(pipe.reader()); };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(interrupt(signal, wait), ::testing::ExitedWithCode(0), "");
  }
}

using OpenForAppending = tests::FolderTest;

TEST_F(OpenForAppending, AppendsToAFile) {
  std::ofstream(path("file")) << "a";
  const int descriptor = open_for_appending(path("file"));
  ASSERT_GE(descriptor, 0);
  EXPECT_EQ(::write(descriptor, "b", 1), 1);
  ::close(descriptor);
  EXPECT_EQ(read("file"), "ab");
  EXPECT_LT(open_for_appending(path("missing")), 0);
}

TEST_F(OpenForAppending, WaitsForTheReaderOfAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::atomic<int> reader = -1;
  std::thread reading([&] { reader = ::open(path("pipe").c_str(), O_RDONLY); });
  const int writer = open_for_appending(path("pipe"));
  reading.join();
  ASSERT_GE(writer, 0);
  EXPECT_EQ(::write(writer, "b", 1), 1);
  char byte = 0;
  EXPECT_EQ(::read(reader, &byte, 1), 1);
  ::close(writer);
  ::close(reader);
}

TEST_F(OpenForAppending, EndsWithAnInterrupt) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const auto wait = [this] { static_cast<void>(open_for_appending(path("pipe"))); };
  EXPECT_EXIT(interrupt(SIGINT, wait), ::testing::ExitedWithCode(0), "");
}

// ---- Printing -----------------------------------------------------------------------------------

/// Prints with this as standard output, and exits with 0 if finish_printing() finds no fault.
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

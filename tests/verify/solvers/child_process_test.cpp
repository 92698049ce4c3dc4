#include "verify/solvers/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

// A separate program, because it makes processes, which copy no threads. The limits of a child are
// tested in solver_process_test.cpp, where a solver exceeds them.

namespace touchstone::verify::solvers::child_process_test {
namespace {

using Event = ChildProcess::Event;
constexpr ChildProcess::Seconds long_time(60.0);

/// Waits for a message or the end.
Event next(ChildProcess& child, std::string& message, CapturedOutput& output) {
  for (;;) {
    const Event event = child.wait(long_time, message, output);
    if (event != Event::none) return event;
  }
}

TEST(ChildProcess, MessagesKeepTheirBoundsAndComeBeforeTheEnd) {
  const TemporaryFolder folder;
  ChildProcess child(
      [](const ChildChannel& channel) {
        while (const auto message = channel.receive()) {
          static_cast<void>(channel.send("<" + *message + ">"));
          if (*message == "last") return;
        }
      },
      {}, folder.path());
  CapturedOutput output;
  std::string message;
  child.send("one");
  child.send("two");
  child.send("last");
  for (const std::string expected : {"<one>", "<two>", "<last>"}) {
    ASSERT_EQ(next(child, message, output), Event::message);
    EXPECT_EQ(message, expected);
  }
  EXPECT_EQ(next(child, message, output), Event::ended);
  EXPECT_EQ(child.end(output).failure, (judge::Failure{.kind = judge::Fault::exit, .number = 0}));
}

/// The other ends are in plugin_test.cpp.
TEST(ChildProcess, EndsWithStatusOneIfItsWorkThrows) {
  const TemporaryFolder folder;
  ChildProcess child([](const ChildChannel&) { throw 7; }, {}, folder.path());
  CapturedOutput output;
  std::string message;
  EXPECT_EQ(next(child, message, output), Event::ended);
  EXPECT_EQ(child.end(output).failure, (judge::Failure{.kind = judge::Fault::exit, .number = 1}));
}

/// Interrupts this process again and again, each time for longer than a child needs to print and
/// to send.
class Interruptions {
 public:
  Interruptions() : before_(std::signal(SIGALRM, interrupt)) { start(); }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;
  Interruptions(Interruptions&&) = delete;
  Interruptions& operator=(Interruptions&&) = delete;
  ~Interruptions() {
    std::signal(SIGALRM, SIG_IGN);
    const itimerval none{};
    ::setitimer(ITIMER_REAL, &none, nullptr);
    std::signal(SIGALRM, before_);
  }

 private:
  static void interrupt(int) {
    ::usleep(30);
    start();
  }

  /// The time differs, to meet every step of this process.
  static void start() {
    static suseconds_t microseconds = 0;
    microseconds = microseconds % 97 + 4;
    const itimerval once{.it_interval = {}, .it_value = {.tv_sec = 0, .tv_usec = microseconds}};
    ::setitimer(ITIMER_REAL, &once, nullptr);
  }

  void (*before_)(int);
};

/// The first text wakes the parent, which is interrupted between any two of its steps.
TEST(ChildProcess, WhatIsPrintedBeforeAMessageIsReadWithIt) {
  const TemporaryFolder folder;
  ChildProcess child(
      [](const ChildChannel& channel) {
        while (const auto message = channel.receive()) {
          if (::write(STDERR_FILENO, "first ", 6) != 6) return;
          if (::write(STDOUT_FILENO, "second", 6) != 6) return;
          if (!channel.send(*message)) return;
        }
      },
      {}, folder.path());
  const Interruptions interruptions;
  std::string message;
  for (int round = 0; round < 10000; ++round) {
    CapturedOutput output;
    child.send("go");
    ASSERT_EQ(next(child, message, output), Event::message);
    ASSERT_EQ(output.text, "first second") << round;
  }
}

TEST(ChildProcess, TellsWorkFromSleep) {
  const TemporaryFolder folder;
  ChildProcess busy(
      [](const ChildChannel& channel) {
        static_cast<void>(channel.send("up"));
        for (volatile bool go_on = true;;) static_cast<void>(go_on);
      },
      {}, folder.path());
  ChildProcess idle([](const ChildChannel& channel) { static_cast<void>(channel.receive()); }, {},
                    folder.path());
  CapturedOutput output;
  std::string message;
  ASSERT_EQ(next(busy, message, output), Event::message);
  EXPECT_TRUE(busy.is_runnable());
  while (busy.processor_seconds() < 0.01) std::this_thread::yield();
  // The child sleeps as soon as it gets there.
  while (idle.is_runnable()) std::this_thread::yield();
}

/// The environment of the child, as text.
std::string world_of_child(const ChildLimits& limits, const std::filesystem::path& folder) {
  ChildProcess child(
      [](const ChildChannel& channel) {
        std::string text = std::filesystem::current_path().string();
        const auto count = std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
        text += " " + std::to_string(count);
        rlimit core{};
        ::getrlimit(RLIMIT_CORE, &core);
        text += " " + std::to_string(core.rlim_cur);
        char byte = 0;
        text += ::read(STDIN_FILENO, &byte, 1) == 0 ? " no input" : " input";
        text += ::getpgrp() == ::getpid() ? " leads" : " follows";
        static_cast<void>(channel.send(text));
      },
      limits, folder);
  CapturedOutput output;
  std::string message;
  EXPECT_EQ(next(child, message, output), Event::message);
  return message;
}

TEST(ChildProcess, HasAWorldOfItsOwn) {
  const TemporaryFolder folder;
  const std::ifstream of_parent("/proc/self/stat");
  // Standard descriptors, connection, lifeline, and the listed folder.
  EXPECT_EQ(world_of_child({}, folder.path()), folder.path().string() + " 6 0 no input leads");
}

TEST(TemporaryFolder, GoesWithWhatIsInIt) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder, other;
    EXPECT_NE(folder.path(), other.path());
    path = folder.path();
    std::filesystem::create_directory(path / "a");
    std::ofstream(path / "a" / "b") << "x";
    EXPECT_TRUE(std::filesystem::exists(path / "a" / "b"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace touchstone::verify::solvers::child_process_test

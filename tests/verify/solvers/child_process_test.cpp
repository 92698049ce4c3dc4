#include "verify/solvers/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

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

/// The other ends are in plugin_method_test.cpp.
TEST(ChildProcess, EndsWithStatusOneIfItsWorkThrows) {
  const TemporaryFolder folder;
  ChildProcess child([](const ChildChannel&) { throw 7; }, {}, folder.path());
  CapturedOutput output;
  std::string message;
  EXPECT_EQ(next(child, message, output), Event::ended);
  EXPECT_EQ(child.end(output).failure, (judge::Failure{.kind = judge::Fault::exit, .number = 1}));
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

#include "verify/jobs/pieces.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

namespace touchstone::verify::jobs::own_program_test {
namespace {

/// The program is this test program, which has an option for each outcome.
class OwnProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    // A shard of the tests is none of the child's.
    for (const char* name : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) ::unsetenv(name);
  }
};

TEST_F(OwnProgram, ReturnsItsExitStatus) {
  const std::string only = "--gtest_filter=OwnProgram.*Child*";
  EXPECT_EQ(run_own_program({"x", only, "--gtest_also_run_disabled_tests", "--gtest_brief=1"}), 1);
  EXPECT_EQ(run_own_program({"x", only, "--gtest_brief=1"}), 0);
  EXPECT_EQ(run_own_program({"x", "--gtest_filter=OwnProgram.DISABLED_Killed",
                             "--gtest_also_run_disabled_tests"}),
            128 + SIGKILL);
}

TEST_F(OwnProgram, DiesWithTheProcessThatRunsIt) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  // The last copy of this end is that of the program, from the time at which it says so.
  ::setenv("TOUCHSTONE_TEST_PIPE", std::to_string(pipe[1]).c_str(), 1);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::_exit(run_own_program({"x", "--gtest_filter=OwnProgram.DISABLED_SaysSoAndWaits",
                             "--gtest_also_run_disabled_tests"}));
  }
  ::close(pipe[1]);
  char letter = 0;
  ASSERT_EQ(::read(pipe[0], &letter, 1), 1);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_EQ(::read(pipe[0], &letter, 1), 0) << "it lives on";
  ::close(pipe[0]);
}

TEST_F(OwnProgram, DISABLED_SaysSoAndWaits) {
  const int pipe = std::stoi(std::getenv("TOUCHSTONE_TEST_PIPE"));
  ASSERT_EQ(::write(pipe, "x", 1), 1);
  ::sleep(60);
  static_cast<void>(::write(pipe, "y", 1));
}

TEST_F(OwnProgram, ChildPasses) {}

TEST_F(OwnProgram, DISABLED_ChildFails) { FAIL(); }

TEST_F(OwnProgram, DISABLED_Killed) { std::raise(SIGKILL); }

}  // namespace
}  // namespace touchstone::verify::jobs::own_program_test

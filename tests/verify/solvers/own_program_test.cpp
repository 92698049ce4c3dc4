#include "verify/solvers/own_program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

namespace touchstone::verify::solvers::own_program_test {
namespace {

// The program is this test program, which has an option for each outcome.

TEST(OwnProgram, ReturnsItsExitStatus) {
  // A shard of the tests is none of the child's.
  for (const char* name : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) ::unsetenv(name);
  const std::string only = "--gtest_filter=OwnProgram.*Child*";
  EXPECT_EQ(run_own_program({"x", only, "--gtest_also_run_disabled_tests", "--gtest_brief=1"}), 1);
  EXPECT_EQ(run_own_program({"x", only, "--gtest_brief=1"}), 0);
  EXPECT_EQ(run_own_program({"x", "--gtest_filter=OwnProgram.DISABLED_Killed",
                             "--gtest_also_run_disabled_tests"}),
            128 + SIGKILL);
}

TEST(OwnProgram, ChildPasses) {}

TEST(OwnProgram, DISABLED_ChildFails) { FAIL(); }

TEST(OwnProgram, DISABLED_Killed) { std::raise(SIGKILL); }

}  // namespace
}  // namespace touchstone::verify::solvers::own_program_test

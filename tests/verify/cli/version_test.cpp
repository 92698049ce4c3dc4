#include "verify/cli/version.hpp"

#include <gtest/gtest.h>

#include <regex>

#include "tests/support/tool_test.hpp"

namespace touchstone::verify::cli::version_test {
namespace {

class Version : public tests::ToolTest {};

TEST_F(Version, NamesTheCommitWhereThereIsOne) {
  const tests::Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(std::regex_match(
      outcome.out, std::regex(R"([0-9]+\.[0-9]+\.[0-9]+( \([0-9a-f]{10,}(-dirty)?\))?\n)")))
      << outcome.out;
}

}  // namespace
}  // namespace touchstone::verify::cli::version_test

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"

// Tests of `touchstone derive` that run the tool.

namespace touchstone::verify::cli::derive_command_test {
namespace {

namespace fs = std::filesystem;
using tests::read_file;

constexpr char subcommand[] = "derive";

using Derive = tests::ShellTest<subcommand>;

TEST_F(Derive, EmitsTheHeaderThatIsInTheTree) {
  ASSERT_EQ(run("--model rigorous --emit '" + path("bounds.hpp") + "'"), 0) << read("err");
  EXPECT_EQ(read("bounds.hpp"), read_file(tests::source_folder() +
                                          "/filters/include/touchstone/filters/error_bounds.hpp"));
}

TEST_F(Derive, PrintsAndWritesTheTable) {
  ASSERT_EQ(run("--model published --model rigorous --model observed --precision double "
                "--evaluations 2000 --json '" +
                path("json") + "'"),
            0)
      << read("err");
  EXPECT_NE(read("out").find("6.217248937900877e-15"), std::string::npos);
  const nlohmann::json result = json();
  EXPECT_EQ(result.at("evaluations"), 2000);
  ASSERT_EQ(result.at("bounds").size(), 22U);
  const nlohmann::json row = result.at("bounds")[0];
  EXPECT_EQ(row.at("expression"), "edge_edge");
  EXPECT_EQ(row.at("precision"), "double");
  EXPECT_EQ(row.at("published_constant"), "6.217248937900877e-15");
  EXPECT_EQ(row.at("published"), 6.217248937900877e-15);
  EXPECT_EQ(row.at("published_units"), 56);
  EXPECT_TRUE(row.at("gappa").is_null());
  EXPECT_EQ(row.at("worst_input").at("coordinates").size(), 8U);
  EXPECT_GT(row.at("tightness"), 1.0);
}

TEST_F(Derive, PrintsTheRowsOfPairsOfDoubles) {
  ASSERT_EQ(run("--model rigorous --model observed --precision double_double --evaluations 2000 "
                "--json '" +
                path("json") + "'"),
            0)
      << read("err");
  EXPECT_NE(read("out").find("determinant_end    double_double"), std::string::npos) << read("out");
  ASSERT_EQ(json().at("bounds").size(), 4U);
  const nlohmann::json row = json().at("bounds")[0];
  EXPECT_EQ(row.at("precision"), "double_double");
  EXPECT_TRUE(row.at("published_constant").is_null());
  EXPECT_DOUBLE_EQ(row.at("rigorous"), 0x1p-97);
  EXPECT_EQ(row.at("worst_input").at("coordinates").size(), 18U);
}

TEST_F(Derive, TakesGappasAnswersFromGappa) {
  // A program that answers 3/2^25 to everything. (error_bounds_test.cpp asks the real one.)
  std::ofstream(path("gappa")) << "#!/bin/sh\n"
                                  "echo 'Results:'\n"
                                  "echo '  |n - N| in [0, 3b-25 {8.9407e-08, 2^(-23.4)}]'\n";
  fs::permissions(path("gappa"), fs::perms::owner_all);
  ASSERT_EQ(run("--model gappa --precision float --json '" + path("json") + "'",
                "PATH='" + path("") + "'"),
            0)
      << read("err");
  const nlohmann::json result = json();
  for (const nlohmann::json& row : result.at("bounds")) EXPECT_EQ(row.at("gappa_units"), 1.5);
  EXPECT_NE(read("out").find("1.5 u"), std::string::npos);
}

TEST_F(Derive, NamesThePackageWhereGappaIsMissing) {
  EXPECT_EQ(run("--model gappa", "PATH=/nonexistent"), 2);
  EXPECT_NE(read("err").find("install the Debian package gappa"), std::string::npos);
  EXPECT_EQ(run("--evaluations 10", "PATH=/nonexistent"), 0) << "not asked for by name";
  EXPECT_NE(read("err").find("install the Debian package gappa"), std::string::npos);
}

TEST_F(Derive, RefusesBadUsageAndOutputsOfOneName) {
  EXPECT_EQ(run("--model nonsense"), 2);
  EXPECT_EQ(run("--precision half"), 2);
  EXPECT_EQ(run("--evaluations 0"), 2);
  EXPECT_EQ(run("--emit '" + path("x") + "' --json '" + path("x") + "'"), 2);
  EXPECT_EQ(run("--model rigorous --json '" + path("no/such/folder") + "'"), 2);
}

}  // namespace
}  // namespace touchstone::verify::cli::derive_command_test

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/tool_test.hpp"

// The script that authors of solvers run in their CI (examples/ci/), with little work.

namespace touchstone::verify::cli::ci_example_test {
namespace {

using tests::contains;
using tests::Outcome;

class CiExample : public tests::ToolTest {
 protected:
  /// Checks the plugin that is built in a folder.
  [[nodiscard]] Outcome check(const std::string& source, const std::string& library,
                              const std::string& settings = "") const {
    const std::string script = tests::source_folder() + "/examples/ci/check_solver.sh";
    return finish(start({"-c", fmt::format("cd '{}' && TOUCHSTONE='{}' FUZZ_LIMIT='--queries 3000' "
                                           "CERTIFY_OPTIONS='--count 2' {} '{}' '{}' '{}'",
                                           folder().string(), tests::touchstone_program(), settings,
                                           script, source, library)},
                        to_file, "/bin/sh"));
  }

  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(path(name));
  }
};

TEST_F(CiExample, IsContentWithAPluginThatMissesNothing) {
  const Outcome outcome = check(tests::source_folder() + "/examples/plugin", "box_overlap.so");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "certify: 0, fuzz: 0")) << outcome.out;
  EXPECT_TRUE(exists("findings/certify.json"));
  EXPECT_TRUE(exists("findings/fuzz/findings.json"));
  EXPECT_FALSE(exists("findings/fuzz/1-false_negative.md"));
}

/// A plugin whose filter has min instead of max.
TEST_F(CiExample, FailsOnFalseNegativesAndKeepsThem) {
  const std::string root = tests::source_folder();
  write("plugin/CMakeLists.txt",
        fmt::format("cmake_minimum_required(VERSION 3.25)\nproject(bad LANGUAGES CXX)\n"
                    "add_library(bad MODULE {}/tests/faults/min_for_max.cpp)\n"
                    "target_include_directories(bad PRIVATE ${{TOUCHSTONE_INCLUDE}})\n"
                    "set_target_properties(bad PROPERTIES PREFIX \"\")\n",
                    root));
  const Outcome outcome = check(path("plugin"), "bad.so");
  EXPECT_EQ(outcome.status, 1) << outcome.out << outcome.err;
  EXPECT_TRUE(exists("findings/certify.json"));
  EXPECT_TRUE(exists("findings/fuzz/1-false_negative.md")) << outcome.out;
  EXPECT_TRUE(exists("findings/fuzz/1-false_negative.cert"));
  EXPECT_EQ(json("findings/fuzz/findings.json").at("asked").at("only"),
            nlohmann::json({"false_negative"}));
}

TEST_F(CiExample, SaysIfThePluginCannotBeBuiltOrJudged) {
  EXPECT_EQ(check(path("nothing"), "bad.so").status, 2);
  EXPECT_EQ(check(tests::source_folder() + "/examples/plugin", "other.so").status, 2);
  EXPECT_EQ(check(tests::source_folder() + "/examples/plugin", "box_overlap.so",
                  "SOLVER_OPTIONS=--no-such-option FINDINGS=more")
                .status,
            2);
}

TEST_F(CiExample, IsWhatBothServicesRun) {
  const std::string folder = tests::source_folder() + "/examples/ci/";
  for (const std::string service : {"github.yml", "gitlab.yml"}) {
    const std::string text = tests::read_file(folder + service);
    EXPECT_TRUE(
        contains(text, "examples/ci/check_solver.sh \"$PLUGIN_SOURCE\" \"$PLUGIN_LIBRARY\""));
    EXPECT_TRUE(contains(text, "FUZZ_LIMIT: --seconds 120"));
    EXPECT_TRUE(contains(text, "findings"));
  }
}

}  // namespace
}  // namespace touchstone::verify::cli::ci_example_test

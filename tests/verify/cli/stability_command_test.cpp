#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"

// Tests of `touchstone stability` that run the tool.

namespace touchstone::verify::cli::stability_command_test {
namespace {

using tests::contains;
constexpr char subcommand[] = "stability";

using Stability = tests::ShellTest<subcommand>;

const std::string quick = " --count 2 --hardness angle ";

TEST_F(Stability, WritesTableJsonAndPicture) {
  ASSERT_EQ(run(quick + "--method certified --seed 9 --json " + quoted("json") + " --picture " +
                quoted("map.html")),
            0)
      << read("err");
  EXPECT_EQ(read("err"), "");
  EXPECT_TRUE(contains(read("out"), "certified (exact): keeps its promise\n")) << read("out");
  EXPECT_TRUE(contains(read("out"), "vertex-face  ...........     ...........       22  "));
  const nlohmann::json result = json();
  EXPECT_EQ(result.at("seed"), 9);
  EXPECT_EQ(result.at("count"), 2);
  ASSERT_EQ(result.at("methods").size(), 1U);
  const nlohmann::json cells = result.at("methods")[0].at("cells");
  ASSERT_EQ(cells.size(), 22U);
  EXPECT_EQ(cells[0].at("hardness"), "angle");
  EXPECT_EQ(cells[0].at("collisions"), 1);
  EXPECT_GE(cells[0].at("checks_per_query"), 1.0) << "stages";
  const std::string page = read("map.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(contains(page, "<li>certified (exact): keeps its promise.</li>"));
  EXPECT_TRUE(contains(page, "<pre class=\"command\">touchstone stability --count 2 "));
}

TEST_F(Stability, WithoutAMethodAllOfOursAreJudged) {
  ASSERT_EQ(run("--count 1 --hardness offset --max-checks 1000 --json " + quoted("json")), 0)
      << read("out") << read("err");
  std::string names;
  const nlohmann::json methods = json().at("methods");
  for (const nlohmann::json& method : methods) names += method.at("name").get<std::string>() + " ";
  EXPECT_EQ(names, "certified tight_inclusion tight_inclusion_published tight_inclusion_float ");
}

TEST_F(Stability, RatesAreTheSameForAnyNumberOfThreads) {
  const auto rates = [&](const std::string& threads) {
    EXPECT_EQ(run(quick + "--plugin '" + tests::plugin_library("box_overlap") + "' --threads " +
                  threads + " --json " + quoted("json")),
              0);
    nlohmann::json result = json();
    for (nlohmann::json& cell : result.at("methods")[0].at("cells")) cell.erase("ns_per_query");
    return result;
  };
  EXPECT_EQ(rates("1"), rates("3"));
}

TEST_F(Stability, ABrokenPromiseExitsWithOne) {
  EXPECT_EQ(run(quick + "--plugin '" + tests::plugin_library("misbehaving") + "' --json " +
                quoted("json")),
            1);
  EXPECT_EQ(json().at("methods")[0].at("keeps_promise"), false);
  EXPECT_EQ(run(quick + "--plugin '" + tests::plugin_library("box_overlap") + "'"), 0);
  EXPECT_EQ(run(quick + "--exact --plugin '" + tests::plugin_library("box_overlap") + "'"), 1)
      << read("out");
}

TEST_F(Stability, TakesASeparation) {
  ASSERT_EQ(
      run(quick + "--method certified --min-separation 0x1p-7 --norm l2 --json " + quoted("json")),
      0)
      << read("out") << read("err");
  EXPECT_TRUE(contains(read("out"), "minimum separation 0.0078125 (l2)\n")) << read("out");
  EXPECT_EQ(json().at("separation").at("norm"), "l2");
}

TEST_F(Stability, BadUsageExitsWithTwo) {
  for (const std::string arguments :
       {"--hardness easy", "--method nonsense", "--count 0", "--min-separation 1e9", "--norm l3",
        "--picture '/nonexistent/map.html'", "paths"}) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_FALSE(read("err").empty());
  }
  EXPECT_EQ(run(quick + "--json " + quoted("one") + " --picture " + quoted("one")), 2);
  EXPECT_TRUE(contains(read("err"), "named for two outputs"));
}

TEST_F(Stability, AnInterruptLeavesWhatIsDone) {
  EXPECT_EQ(run("--count 1000000 --plugin '" + tests::plugin_library("interrupts_its_parent") +
                    "' --json " + quoted("json"),
                "TOUCHSTONE_TEST_CALL=1000"),
            130)
      << read("err");
  EXPECT_EQ(json().at("interrupted"), true);
}

}  // namespace
}  // namespace touchstone::verify::cli::stability_command_test

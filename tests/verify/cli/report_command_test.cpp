#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support/tool_test.hpp"

// Tests of `touchstone report` that run the tool.

namespace touchstone::verify::cli::report_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;

constexpr char subcommand[] = "report";

class Report : public tests::ShellTest<subcommand> {
 protected:
  /// Two queries of a vertex over a resting triangle: one falls through it, one to half its height.
  [[nodiscard]] std::string data() const {
    const auto rows = [](const std::string& height) {
      return "1,1,1,1," + height + ",1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
    };
    fs::create_directories(path("handcrafted"));
    std::ofstream(path("handcrafted/a_vf.csv"), std::ios::binary)
        << rows("1") + rows("-3") + rows("2") + rows("1");
    return quoted("handcrafted");
  }
};

/// Options for a short run: the tests measure no speed.
const std::string quick =
    " --method certified --method tight_inclusion --repetitions 1 --method-seconds 0.01 "
    "--stability 0 ";

TEST_F(Report, WritesPageMeasurementsAndTablesOfTheGivenQueries) {
  ASSERT_EQ(run(data() + quick + "--out " + quoted("page.html") + " --json " + quoted("json") +
                " --markdown " + quoted("results.md")),
            0)
      << read("err");
  EXPECT_EQ(read("err"), "");
  EXPECT_EQ(read("out"), path("page.html") + "\n");
  const nlohmann::json result = json();
  EXPECT_EQ(result.at("interrupted"), false);
  std::set<std::string> experiments;
  for (const nlohmann::json& m : result.at("measurements")) {
    experiments.insert(m.at("experiment").get<std::string>());
    EXPECT_EQ(m.at("group"), "handcrafted");
    EXPECT_EQ(m.at("asked"), 2);
    if (m.at("experiment") == "field") {
      EXPECT_EQ(m.at("collisions"), 1);
    }
    EXPECT_EQ(m.at("false_negatives"), 0);
  }
  EXPECT_EQ(experiments, (std::set<std::string>{"checks", "field", "separation", "tolerance"}));
  EXPECT_TRUE(read("page.html").starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(contains(read("page.html"), "id=\"speed_false_positives\""));
  EXPECT_TRUE(contains(read("results.md"), "### handcrafted, vertex-face"));
  EXPECT_TRUE(contains(read("results.md"), "touchstone report handcrafted "));
}

TEST_F(Report, MakesTheSamePageFromAnEarlierRunsMeasurements) {
  ASSERT_EQ(run(data() + quick + "--out " + quoted("one.html") + " --json " + quoted("json")), 0);
  ASSERT_EQ(run("--from " + quoted("json") + " --out " + quoted("two.html")), 0) << read("err");
  EXPECT_EQ(read("one.html"), read("two.html"));
  EXPECT_GT(read("two.html").size(), 100'000U);
}

/// The plugin is conservative, but claims contact in queries without it.
TEST_F(Report, SeesAPluginBreakItsTolerance) {
  EXPECT_EQ(
      run(data() + quick + "--experiment field --plugin " + tests::plugin_library("always_yes") +
          " --json " + quoted("json") + " --out " + quoted("page.html")),
      1)
      << read("err");
  const nlohmann::json result = json();
  for (const nlohmann::json& m : result.at("measurements")) {
    const bool is_plugin = m.at("method") == "always_yes";
    EXPECT_EQ(m.at("beyond_tolerance"), is_plugin ? 1 : 0);
    EXPECT_EQ(m.at("keeps_promise"), !is_plugin);
  }
}

TEST_F(Report, HasOnesOwnSolverBesideTheOthers) {
  static_cast<void>(data());
  ASSERT_EQ(ToolTest::run({"solve", path("handcrafted"), "--method", "tight_inclusion", "--out",
                           path("answers.csv")})
                .status,
            0);
  ASSERT_EQ(
      run(data() + quick + "--experiment field --plugin " + tests::plugin_library("box_overlap") +
          " --results " + quoted("answers.csv") + " --json " + quoted("json") + " --out " +
          quoted("page.html") + " --compare " + quoted("old.json")),
      2)
      << "nothing to compare with";
  ASSERT_EQ(run(data() + quick + "--experiment field --json " + quoted("old.json")), 0);
  ASSERT_EQ(
      run(data() + quick + "--experiment field --plugin " + tests::plugin_library("box_overlap") +
          " --results " + quoted("answers.csv") + " --json " + quoted("json") + " --out " +
          quoted("page.html") + " --compare " + quoted("old.json")),
      0)
      << read("err");
  std::map<std::string, nlohmann::json> of_method;
  const nlohmann::json result = json();
  for (const nlohmann::json& m : result.at("measurements")) of_method[m.at("method")] = m;
  ASSERT_EQ(of_method.size(), 4U);
  // A vertex that falls to half its height is not in the face's box, so that the example is right.
  EXPECT_EQ(of_method.at("box_overlap").at("false_negatives"), 0);
  EXPECT_GT(of_method.at("box_overlap").at("ns_per_query"), 0.0);
  EXPECT_EQ(of_method.at("answers").at("asked"), 2);
  EXPECT_EQ(of_method.at("answers").at("collisions"), 1);
  EXPECT_EQ(of_method.at("answers").at("false_negatives"), 0);
  EXPECT_TRUE(of_method.at("answers").at("ns_per_query").is_null());
  const std::string page = read("page.html");
  EXPECT_TRUE(contains(page, "What has changed"));
  EXPECT_TRUE(contains(page, "<th scope=\"row\">box_overlap</th><td>new</td>")) << page.size();
  EXPECT_EQ(result.at("groups").size(), 1U);
  EXPECT_EQ(result.at("groups")[0].at("digest").get<std::string>().size(), 16U);
}

TEST_F(Report, WithoutAPathTheQueriesAreTheBuiltInOnes) {
  ASSERT_EQ(
      run(" --method certified --repetitions 1 --method-seconds 0.01 --stability 2 --count 50 "
          "--experiment field --json " +
          quoted("json")),
      0)
      << read("err");
  std::set<std::string> groups;
  const nlohmann::json result = json();
  for (const nlohmann::json& m : result.at("measurements")) {
    groups.insert(m.at("group").get<std::string>() + " " + m.at("kind").get<std::string>());
    EXPECT_EQ(m.at("false_negatives"), 0);
    EXPECT_EQ(m.at("false_positives"), 0);
    EXPECT_LE(m.at("asked"), 50);
  }
  EXPECT_EQ(groups, (std::set<std::string>{"built-in set edge-edge", "built-in set vertex-face",
                                           "patches edge-edge", "patches vertex-face"}));
  EXPECT_EQ(result.at("stability").size(), 10U * 11U * 2U);
}

TEST_F(Report, ABrokenPromiseExitsWithOne) {
  ASSERT_EQ(run(data() + quick + "--json " + quoted("json")), 0);
  nlohmann::json measurements = json();
  measurements["measurements"][0]["keeps_promise"] = false;
  measurements["measurements"][0]["false_negatives"] = 1;
  std::ofstream(path("json")) << measurements;
  EXPECT_EQ(run("--from " + quoted("json") + " --out " + quoted("page.html")), 1);
  EXPECT_TRUE(contains(read("err"),
                       "certified (exact) breaks its promise on handcrafted "
                       "vertex-face, field: false negatives 1"))
      << read("err");
}

TEST_F(Report, BadUsageExitsWithTwo) {
  const std::string out = " --out " + quoted("page.html");
  for (const std::string& arguments :
       {data(), data() + quick + " --out '/nonexistent/page.html'",
        data() + out + " --method nonsense", data() + out + " --count 0",
        data() + out + " --method-seconds 0", data() + out + " --experiment guess",
        quoted("missing") + out, "--from " + quoted("missing") + out,
        data() + " --from " + quoted("json") + out, data() + out + " --json " + quoted("page.html"),
        data() + " --json " + quoted("handcrafted/a_vf.csv")}) {
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_FALSE(read("err").empty()) << arguments;
  }
  std::ofstream(path("json")) << "{}";
  EXPECT_EQ(run("--from " + quoted("json") + out), 2);
  EXPECT_TRUE(contains(read("err"), path("json") + ": not the measurements of a report"));
  EXPECT_FALSE(fs::exists(path("page.html")));
}

TEST_F(Report, AnInterruptLeavesWhatIsMeasured) {
  static_cast<void>(data());
  const tests::Outcome report =
      run_interrupted({"report", path("handcrafted"), "--method-seconds", "100", "--repetitions",
                       "1000000", "--json", path("json"), "--out", path("page.html")});
  EXPECT_EQ(report.status, 130) << report.err;
  EXPECT_EQ(json().at("interrupted"), true);
  EXPECT_TRUE(contains(read("page.html"), "Not all that was asked"));
}

}  // namespace
}  // namespace touchstone::verify::cli::report_command_test

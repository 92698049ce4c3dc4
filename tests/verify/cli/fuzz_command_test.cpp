#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/tool_test.hpp"

// Tests of `touchstone fuzz` that run the tool. The plugin is the example, which compares swept
// boxes and is conservative, but far from exact.

namespace touchstone::verify::cli::fuzz_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using tests::Outcome;
using tests::read_file;

class FuzzTool : public tests::ToolTest {
 protected:
  [[nodiscard]] Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "fuzz");
    return finish(start(arguments));
  }

  /// Runs commands in the test's folder, with the tool in the path.
  [[nodiscard]] Outcome run_in_shell(const std::string& commands) const {
    const fs::path tools = fs::path(tests::touchstone_program()).parent_path();
    return finish(start({"-c", fmt::format("PATH={}:$PATH\ncd '{}'\n{}", tools.string(),
                                           folder().string(), commands)},
                        to_file, "/bin/sh"));
  }

  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(read_file(path(name)));
  }
};

TEST_F(FuzzTool, FindsNothingInTheCertifiedSolver) {
  const Outcome outcome = run({"--method", "certified", "--queries", "3000", "--json", path("j")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "no findings")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "3000 queries")) << outcome.out;
  EXPECT_EQ(json("j").at("queries"), 3000);
  EXPECT_EQ(json("j").at("judged_by_oracle"), 3000);
  EXPECT_TRUE(json("j").at("findings").empty());
  EXPECT_EQ(json("j").at("generators").size(), 13U);
}

TEST_F(FuzzTool, HoldsAPluginToExactnessAndWritesWhatItFinds) {
  const Outcome outcome =
      run({"--plugin", tests::plugin_library("box_overlap"), "--exact", "--queries", "5000",
           "--most-findings", "3", "--out", path("found.csv"), "--json", path("j")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  for (const std::string part :
       {"false_positive of box_overlap", "truth: no collision", "group  finding"}) {
    EXPECT_TRUE(contains(outcome.out, part)) << part << '\n' << outcome.out;
  }
  EXPECT_FALSE(contains(outcome.out, "TEST("));
  const nlohmann::json report = json("j");
  EXPECT_GE(report.at("groups").size(), 1U);
  EXPECT_LE(report.at("groups").size(), 3U);
  ASSERT_GE(report.at("findings").size(), 3U);
  for (const nlohmann::json& finding : report.at("findings")) {
    EXPECT_EQ(finding.at("what"), "false_positive");
    EXPECT_LT(finding.at("group"), report.at("groups").size());
    EXPECT_TRUE(contains(finding.at("certificate"), "no_collision"));
    EXPECT_EQ(finding.at("collides"), false);
    EXPECT_EQ(finding.at("original").at("collides"), false);
    EXPECT_EQ(finding.at("coordinates").size(), 24U);
  }
  // The dataset holds the queries with their truth: its labels are right, and the plugin's answers
  // wrong.
  const auto certify = [&](const std::string& exact) {
    std::vector<std::string> arguments{"certify"};
    for (const auto& entry : fs::directory_iterator(folder())) {
      if (entry.path().extension() == ".csv") arguments.push_back(entry.path().string());
    }
    EXPECT_GT(arguments.size(), 1U);
    arguments.insert(arguments.end(),
                     {"--plugin", tests::plugin_library("box_overlap"), "--json", path("c")});
    if (!exact.empty()) arguments.push_back(exact);
    return finish(start(arguments));
  };
  const Outcome judged = certify("");
  EXPECT_EQ(judged.status, 0) << judged.out << judged.err;
  EXPECT_GE(json("c").at("labels"), 3);
  EXPECT_EQ(certify("--exact").status, 1);
}

TEST_F(FuzzTool, FindsTheSameForTheSameSeed) {
  std::vector<std::string> reports;
  for (const std::string seed : {"4", "4", "5"}) {
    static_cast<void>(run({"--plugin", tests::plugin_library("box_overlap"), "--exact", "--queries",
                           "2000", "--most-findings", "1", "--seed", seed, "--json", path("j")}));
    const nlohmann::json report = json("j");
    reports.push_back(report.at("findings").at(0).at("coordinates").dump() +
                      report.at("findings").at(0).at("original").at("coordinates").dump() +
                      report.at("queries").dump());
  }
  EXPECT_EQ(reports[0], reports[1]);
  EXPECT_NE(reports[0], reports[2]);
}

/// The report contains a certificate of the query that it shows, and one of the original.
TEST_F(FuzzTool, WritesCertificatesThatTheCheckerAccepts) {
  const Outcome outcome = run({"--plugin", tests::plugin_library("box_overlap"), "--exact",
                               "--queries", "5000", "--most-findings", "2", "--json", path("j")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const nlohmann::json report = json("j");
  for (const nlohmann::json& finding : report.at("findings")) {
    for (const nlohmann::json& failing : {finding, finding.at("original")}) {
      const std::string certificate = failing.at("certificate");
      std::ofstream(path("one.cert")) << certificate;
      const Outcome checked = finish(start({path("one.cert")}, to_file, tests::checker_program()));
      EXPECT_EQ(checked.status, 0) << checked.out << checked.err << certificate;
      EXPECT_TRUE(contains(checked.out, "1")) << checked.out;
    }
  }
}

/// The fault shows only with the options of the solver's call.
TEST_F(FuzzTool, PrintsACommandThatFindsTheSame) {
  const Outcome outcome =
      run({"--plugin", tests::plugin_library("wrong_with_options"), "--tolerance", "0.125",
           "--max-checks", "77", "--min-separation", "0.25", "--norm", "l2", "--query-limit", "20",
           "--queries", "500", "--most-findings", "1", "--json", path("j")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const nlohmann::json finding = json("j").at("findings").at(0);
  EXPECT_EQ(finding.at("solver").at("plugin"), tests::plugin_library("wrong_with_options"));
  EXPECT_EQ(finding.at("solver").at("tolerance"), 0.125);
  EXPECT_EQ(finding.at("solver").at("max_checks"), 77);
  EXPECT_EQ(finding.at("solver").at("query_limit"), 20.0);
  const std::string command = finding.at("command");
  const Outcome again = run_in_shell(command);
  EXPECT_EQ(again.status, 1) << command << again.out << again.err;
  EXPECT_TRUE(contains(again.out, "wrong_with_options")) << again.out;
  std::string other = command;
  other.replace(other.find("--max-checks 77"), 15, "--max-checks 78");
  EXPECT_EQ(run_in_shell(other).status, 0);
}

/// The page for a maintainer: its certificate is accepted, and its command finds the same.
TEST_F(FuzzTool, WritesPagesForAnIssueTracker) {
  const std::string folder = path("pages");
  const std::vector<std::string> arguments{"--plugin",        tests::plugin_library("always_no"),
                                           "--queries",       "1000",
                                           "--most-findings", "1",
                                           "--write",         folder};
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "written: " + folder + "/1-false_negative.md")) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "after ")) << outcome.err;
  const std::string page = read_file(folder + "/1-false_negative.md");
  EXPECT_TRUE(contains(page, "# always_no misses a collision")) << page;
  const Outcome checked =
      finish(start({folder + "/1-false_negative.cert"}, to_file, tests::checker_program()));
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
  const nlohmann::json report = nlohmann::json::parse(read_file(folder + "/findings.json"));
  const std::size_t number = report.at("groups").at(0).at("best");
  const nlohmann::json best = report.at("findings").at(number);
  EXPECT_TRUE(contains(page, best.at("command").get<std::string>()));
  EXPECT_EQ(run_in_shell(best.at("command")).status, 1);
  // The answer does not depend on the scale.
  EXPECT_EQ(report.at("groups").at(0).at("scale"), "any scale");
  // The existing folder stays.
  const Outcome again = run(arguments);
  EXPECT_EQ(again.status, 2);
  EXPECT_TRUE(contains(again.err, "is not an empty folder")) << again.err;
}

TEST_F(FuzzTool, IsNotContentWhereNothingWasJudged) {
  const std::string plugin = tests::plugin_library("never_answers");
  const Outcome outcome =
      run({"--plugin", plugin, "--seconds", "0.3", "--query-limit", "1000", "--json", path("j")});
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "nothing was judged: never_answers")) << outcome.err;
  EXPECT_EQ(json("j").at("queries"), 0);
  EXPECT_EQ(json("j").at("ended_by"), "time");
}

TEST_F(FuzzTool, FindsAHang) {
  const Outcome outcome = run({"--plugin", tests::plugin_library("never_answers"), "--query-limit",
                               "0.05", "--queries", "1"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "hang of never_answers")) << outcome.out;
}

TEST_F(FuzzTool, SeeksFindingsOfOneKindOnly) {
  const std::string plugin = tests::plugin_library("box_overlap");
  const Outcome other = run({"--plugin", plugin, "--exact", "--queries", "1000", "--only",
                             "false_negative", "--only", "hang", "--json", path("j")});
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_TRUE(contains(other.out, "of kinds that were not sought")) << other.out;
  EXPECT_EQ(json("j").at("asked").at("only"), nlohmann::json({"false_negative", "hang"}));
  EXPECT_EQ(
      run({"--plugin", plugin, "--exact", "--queries", "1000", "--only", "false_positive"}).status,
      1);
  EXPECT_EQ(run({"--plugin", plugin, "--queries", "1000", "--only", "wrong"}).status, 2);
}

/// The tolerance is the one that the plugin states.
TEST_F(FuzzTool, FindsAYesBeyondAPluginsTolerance) {
  const Outcome outcome = run({"--plugin", tests::plugin_library("always_yes"), "--queries", "500",
                               "--most-findings", "1", "--json", path("j")});
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_EQ(json("j").at("findings").at(0).at("what"), "beyond_tolerance");
}

TEST_F(FuzzTool, SaysIfTheTimeWasTooShortForTheQueries) {
  const Outcome outcome =
      run({"--method", "certified", "--queries", "1000000000000", "--seconds", "0.5"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, " of 1000000000000 queries judged in 0.5 s")) << outcome.out;
}

/// The dataset records the distance of its truth.
TEST_F(FuzzTool, SearchesAtASeparation) {
  const std::string out = path("near-vertex-face.csv");
  const Outcome outcome = run({"--plugin", tests::plugin_library("box_overlap"), "--exact",
                               "--min-separation", "0.25", "--norm", "l2", "--kind", "vertex-face",
                               "--queries", "3000", "--most-findings", "1", "--out", out});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "at minimum separation 0.25 (l2)")) << outcome.out;
  EXPECT_TRUE(fs::exists(path("separation.json")));
  const Outcome certified = finish(start({"certify", out}));
  EXPECT_EQ(certified.status, 0) << certified.out;
  EXPECT_TRUE(contains(certified.out, "0.25 (l2)")) << certified.out;
  // A folder of datasets has one separation only.
  const Outcome other = run({"--method", "certified", "--queries", "10", "--out",
                             path("contact-vertex-face.csv"), "--kind", "vertex-face"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "choose another")) << other.err;
}

TEST_F(FuzzTool, MutatesACorpus) {
  std::ofstream(path("corpus_vf.csv")) << "1,1,1,1,1,1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n"
                                          "1,1,1,1,-1,1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  const Outcome outcome =
      run({"--method", "certified", "--queries", "500", "--corpus", path("corpus_vf.csv")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(run({"--method", "certified", "--queries", "500", "--corpus", path("none")}).status, 2);
}

TEST_F(FuzzTool, RefusesWhatMakesNoSense) {
  EXPECT_EQ(run({"--queries", "10"}).status, 2);
  EXPECT_EQ(run({"--method", "nobody", "--queries", "10"}).status, 2);
  EXPECT_EQ(run({"--method", "certified", "--plugin", tests::plugin_library("box_overlap")}).status,
            2);
  EXPECT_EQ(run({"--method", "certified", "--seconds", "-1"}).status, 2);
  EXPECT_EQ(run({"--method", "certified", "--queries", "0"}).status, 2);
  EXPECT_EQ(run({"--method", "certified", "--queries", "10", "--kind", "face-face"}).status, 2);
  EXPECT_EQ(run({"--method", "certified", "--queries", "10", "--out", path("x.npy")}).status, 2);
  EXPECT_EQ(run({"--method", "certified", "--queries", "10", "--out", path("x_vf.csv")}).status, 2);
}

TEST_F(FuzzTool, ReportsWhatWasDoneWhenInterrupted) {
  ::setenv("TOUCHSTONE_TEST_CALL", "1000", 1);
  const Outcome outcome =
      run({"--plugin", tests::plugin_library("interrupts_its_parent"), "--seconds", "600"});
  ::unsetenv("TOUCHSTONE_TEST_CALL");
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "no findings")) << outcome.out;
}

}  // namespace
}  // namespace touchstone::verify::cli::fuzz_command_test

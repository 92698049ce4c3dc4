#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"
#include "tests/verify/solvers/plugins/misbehaviour.hpp"

// Tests of `touchstone bench` that run the tool.

namespace touchstone::verify::cli::bench_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using tests::read_file;

constexpr char subcommand[] = "bench";

using Bench = tests::ShellTest<subcommand>;

/// A vertex that falls to a height over a resting triangle, as rows without labels.
std::string falling_vertex(const std::string& end_height) {
  const auto rows = [](const std::string& height) {
    return "1,1,1,1," + height + ",1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n";
  };
  return rows("1") + rows(end_height);
}

/// Options for a short run: the tests measure no speed.
const std::string quick = " --repetitions 2 --seconds 0.01 ";

TEST_F(Bench, TimesAndJudgesTheGivenQueries) {
  const std::string folder = quoted("data");
  static_cast<void>(write("data/a_vf.csv", falling_vertex("-3") + falling_vertex("0")));
  static_cast<void>(write("data/b_vf.csv", falling_vertex("1")));
  ASSERT_EQ(run(folder + quick + "--method tight_inclusion --json " + quoted("json")), 0)
      << read("err");
  EXPECT_TRUE(contains(read("out"), path("data") + ", vertex-face: 3 queries, 2 collisions; "))
      << read("out");
  EXPECT_EQ(read("err"), "");
  const nlohmann::json result = json();
  EXPECT_EQ(result.at("repetitions"), 2);
  ASSERT_EQ(result.at("groups").size(), 1U) << "both files are one group";
  const nlohmann::json& group = result.at("groups")[0];
  EXPECT_EQ(group.at("name"), path("data"));
  EXPECT_EQ(group.at("kind"), "vertex-face");
  EXPECT_EQ(group.at("queries"), 3);
  EXPECT_EQ(group.at("judged"), 3);
  EXPECT_EQ(group.at("collisions"), 2);
  EXPECT_GT(group.at("memory_pass").at("ns_per_query"), 0.0);
  ASSERT_EQ(group.at("methods").size(), 1U);
  const nlohmann::json& method = group.at("methods")[0];
  EXPECT_EQ(method.at("name"), "tight_inclusion");
  EXPECT_EQ(method.at("queries"), 3);
  EXPECT_GT(method.at("time").at("ns_per_query"), 0.0);
  EXPECT_GT(method.at("passes"), 0.0);
  EXPECT_EQ(method.at("single").at("queries"), 3);
  EXPECT_EQ(method.at("judged"), 3);
  EXPECT_EQ(method.at("false_negatives"), 0);
  EXPECT_EQ(method.at("toi_error").at("count"), 2);
}

TEST_F(Bench, WithoutAMethodOurOwnAreTimed) {
  const std::string file = write("a_vf.csv", falling_vertex("-3"));
  ASSERT_EQ(run(file + quick + "--json " + quoted("json")), 0) << read("err");
  const nlohmann::json methods = json().at("groups")[0].at("methods");
  const auto has = [&](const std::string& name) {
    return std::any_of(methods.begin(), methods.end(),
                       [&](const nlohmann::json& method) { return method.at("name") == name; });
  };
  EXPECT_TRUE(has("certified"));
  EXPECT_TRUE(has("tight_inclusion"));
}

TEST_F(Bench, AFileHasItsOwnGroup) {
  const std::string first = write("a_vf.csv", falling_vertex("-3"));
  const std::string second = write("b_ee.csv", falling_vertex("-3"));
  ASSERT_EQ(run(first + " " + second + quick + "--method certified --kernel scalar --json " +
                quoted("json")),
            0)
      << read("err");
  const nlohmann::json groups = json().at("groups");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].at("name"), path("a_vf.csv"));
  EXPECT_EQ(groups[1].at("kind"), "edge-edge");
  EXPECT_EQ(groups[0].at("methods")[0].at("stages").size(), 5U);
}

TEST_F(Bench, ABrokenPromiseExitsWithOne) {
  const std::string file = write("a_vf.csv", falling_vertex("-3"));
  EXPECT_EQ(run(file + quick + "--plugin '" + tests::plugin_library("box_overlap") + "' --json " +
                quoted("json")),
            0)
      << read("err");
  EXPECT_EQ(run(file + quick + "--plugin '" + tests::plugin_library("misbehaving") + "' --json " +
                quoted("json")),
            1)
      << read("out") << read("err");
  EXPECT_TRUE(json().at("groups")[0].at("methods")[0].at("broke_promise").get<bool>());
  EXPECT_TRUE(contains(read("out"), path("a_vf.csv") + ": vertex-face query 0: answer"))
      << read("out");
}

/// The plugin is conservative, but claims contact in queries without it.
TEST_F(Bench, APluginThatBreaksItsToleranceExitsWithOne) {
  const std::string file = write("a_vf.csv", falling_vertex("-3") + falling_vertex("0.5"));
  EXPECT_EQ(run(file + quick + "--plugin '" + tests::plugin_library("always_yes") + "' --json " +
                quoted("json")),
            1)
      << read("err");
  const nlohmann::json method = json().at("groups")[0].at("methods")[0];
  EXPECT_EQ(method.at("beyond_tolerance"), 1);
  EXPECT_EQ(method.at("broke_promise"), true);
  EXPECT_TRUE(contains(read("out"), "  beyond tol\n")) << read("out");
  EXPECT_TRUE(contains(read("out"),
                       "beyond tolerance: always_yes: " + path("a_vf.csv") +
                           ": vertex-face query 1: answer yes, tolerance 0, truth no collision\n"))
      << read("out");
}

TEST_F(Bench, APluginThatCrashesCostsAnAnswer) {
  std::string crashing = falling_vertex("-3");
  const std::string what = std::to_string(static_cast<int>(tests::Misbehaviour::writes_to_null));
  crashing.replace(0, 1, what);
  const std::string file = write("a_vf.csv", falling_vertex("-3") + crashing);
  EXPECT_EQ(run(file + quick + "--plugin '" + tests::plugin_library("misbehaving") +
                "' --method certified --json " + quoted("json")),
            1)
      << read("out") << read("err");
  EXPECT_TRUE(contains(read("out"), "vertex-face query 1: answer crash: SIGSEGV")) << read("out");
  EXPECT_EQ(json().at("groups")[0].at("methods").size(), 2U);
}

TEST_F(Bench, TheBuiltInWorkloadIsPatchesAndTheBuiltInSet) {
  ASSERT_EQ(run("--count 2 --judge 100 --kind edge-edge --repetitions 1 --seconds 0.001 --method "
                "tight_inclusion --json " +
                quoted("json")),
            0)
      << read("err") << read("out");
  const nlohmann::json groups = json().at("groups");
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].at("name"), "patches");
  EXPECT_GE(groups[0].at("queries"), 100'000);
  EXPECT_GE(groups[0].at("judged"), 100);
  ASSERT_EQ(groups[0].at("methods").size(), 3U);
  EXPECT_LT(groups[0].at("methods")[0].at("queries"), groups[0].at("queries"));
  EXPECT_EQ(groups[0].at("methods")[1].at("name"), "certified_queries");
  EXPECT_EQ(groups[0].at("methods")[2].at("name"), "certified_pairs");
  EXPECT_EQ(groups[0].at("methods")[2].at("queries"), groups[0].at("queries"));
  EXPECT_EQ(groups[1].at("name"), "built-in set");
  EXPECT_TRUE(json().at("step").is_null());
}

TEST_F(Bench, AStepIsTimedFromEndToEnd) {
  const std::string faces = "f 1 2 3\nf 4 5 6\n";
  const std::string resting = "v 0 0 0\nv 4 0 0\nv 0 4 0\n";
  const std::string before = write("before.obj", resting + "v 1 1 1\nv 2 1 1\nv 1 2 1\n" + faces);
  const std::string after = write("after.obj", resting + "v 1 1 -1\nv 2 1 -1\nv 1 2 -1\n" + faces);
  ASSERT_EQ(run("--step " + before + " " + after + quick + "--threads 2 --json " + quoted("json")),
            0)
      << read("err") << read("out");
  const nlohmann::json result = json();
  ASSERT_EQ(result.at("groups").size(), 2U);
  EXPECT_EQ(result.at("groups")[0].at("queries"), 3);
  EXPECT_EQ(result.at("groups")[0].at("collisions"), 3);
  const nlohmann::json& step = result.at("step");
  EXPECT_EQ(step.at("name"), "before-after");
  EXPECT_EQ(step.at("vertices"), 6);
  EXPECT_EQ(step.at("edges"), 6);
  EXPECT_EQ(step.at("faces"), 2);
  EXPECT_EQ(step.at("vertex_face"), (nlohmann::json{{"candidates", 3}, {"collisions", 3}}));
  EXPECT_LE(step.at("earliest").at("toi_lower"), 0.5);
  EXPECT_GE(step.at("earliest").at("toi_upper"), 0.5);
  EXPECT_EQ(step.at("earliest_agrees"), true);
  ASSERT_EQ(step.at("times").size(), 2U);
  EXPECT_EQ(step.at("times")[1].at("threads"), 2);
  EXPECT_GT(step.at("times")[1].at("collisions_processor_s"), 0.0);
  EXPECT_TRUE(contains(read("out"), "before-after: 6 vertices, 6 edges, 2 faces; ")) << read("out");
}

TEST_F(Bench, BadUsageExitsWithTwo) {
  const std::string file = write("a_vf.csv", falling_vertex("-3"));
  std::string json_to_input = " --json ";
  json_to_input += file;
  for (const std::string& arguments :
       {std::string("--nonsense"), file + " --method nonsense", file + " --repetitions 0",
        file + " --seconds 0", file + " --judge -1", file + " --kernel nonsense",
        file + " --query-limit -1", file + " --step x y", std::string("--step x"),
        file + " --plugin " + quoted("missing.so"), file + json_to_input, quoted("missing"),
        "--step " + quoted("missing0.ply") + " " + quoted("missing1.ply")}) {
    EXPECT_EQ(run(arguments), 2) << arguments << read("err");
    EXPECT_NE(read("err"), "") << arguments;
  }
  EXPECT_EQ(read_file(path("a_vf.csv")), falling_vertex("-3"));
}

TEST_F(Bench, BadInputExitsWithTwoAndIsNamedOnce) {
  const std::string bad = "1,0,1,1,1,1\n";
  static_cast<void>(write("data/a_vf.csv", falling_vertex("-3") + bad));
  static_cast<void>(write("data/b.csv", falling_vertex("-3")));
  static_cast<void>(write("data/c_vf.csv", falling_vertex("1")));
  EXPECT_EQ(run(quoted("data") + quick + "--method tight_inclusion --json " + quoted("json")), 2);
  EXPECT_TRUE(contains(read("err"), path("data/a_vf.csv") + ":9:2: ")) << read("err");
  EXPECT_TRUE(json().at("groups").empty()) << "half of the data is no group";

  EXPECT_EQ(run(quoted("data") + quick + "--keep-going --method tight_inclusion --json " +
                quoted("json")),
            2);
  EXPECT_EQ(json().at("groups")[0].at("queries"), 2);
  const std::string errors = read("err");
  const std::size_t first = errors.find(path("data/b.csv"));
  ASSERT_NE(first, std::string::npos) << errors;
  EXPECT_EQ(errors.find(path("data/b.csv"), first + 1), std::string::npos) << errors;
}

TEST_F(Bench, AnInterruptKeepsWhatIsDone) {
  const std::string file = write("a_vf.csv", falling_vertex("-3"));
  // The interrupt is so late that the solver is measured, not only tried.
  ASSERT_EQ(run(file + " --plugin '" + tests::plugin_library("interrupts_its_parent") +
                    "' --repetitions 1000000 --json " + quoted("json"),
                "TOUCHSTONE_TEST_CALL=10000"),
            130)
      << read("err");
  const nlohmann::json group = json().at("groups")[0];
  EXPECT_EQ(group.at("interrupted"), true);
  EXPECT_FALSE(group.at("memory_pass").at("repetitions").empty());
  EXPECT_EQ(group.at("judged"), 0);
  EXPECT_TRUE(contains(read("out"), "(interrupted)")) << read("out");
}

}  // namespace
}  // namespace touchstone::verify::cli::bench_command_test

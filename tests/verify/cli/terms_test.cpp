/// \file
/// Solvers that are right on their own terms (solvers/plugins/own_terms.cpp), judged before the
/// terms are named, and after.

#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"

namespace touchstone::verify::cli::terms_test {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

class Terms : public tests::ToolTest {
 protected:
  /// The judgement of certify on a plugin; its exit status too, as "status".
  [[nodiscard]] Json certify(const std::string& plugin, const Words& more,
                             Words sources = {}) const {
    if (sources.empty()) sources = {"--count", "12"};
    Words words{"certify", "--plugin", tests::plugin_library(plugin), "--json", path("json")};
    words.insert(words.end(), sources.begin(), sources.end());
    words.insert(words.end(), more.begin(), more.end());
    const tests::Outcome outcome = run(words);
    out = outcome.out;
    Json judged = json("json").at("methods").at(0);
    judged["status"] = outcome.status;
    return judged;
  }

  /// A dataset of a vertex that falls onto a triangle at x = `x`, from that height to below it.
  [[nodiscard]] std::string falling_from(int x, int height = 1) const {
    const std::string face = "0,1,0,1,0,1\n32,1,0,1,0,1\n0,1,32,1,0,1\n";
    const auto vertex = [x](int z) {
      return std::to_string(x) + ",1,1,1," + std::to_string(z) + ",1\n";
    };
    return write("vertex-face.csv", vertex(height) + face + vertex(-1) + face);
  }

  mutable std::string out;
};

std::uint64_t all_faults(const Json& judged) {
  std::uint64_t sum = 0;
  for (const char* const fault : {"false_negatives", "false_positives", "late_toi",
                                  "early_toi_upper", "beyond_tolerance", "undecided", "errors"}) {
    sum += judged.at(fault).get<std::uint64_t>();
  }
  return sum;
}

struct Row {
  std::string plugin;
  std::string fault;  ///< the first of those without the terms
  Words terms;
  bool leaves_out;  ///< Do the terms leave out queries?
};

/// Each row of a table: wrong on others' terms, right on its own, even as an exact solver.
TEST_F(Terms, AreWhatASolverIsJudgedBy) {
  for (const auto& [plugin, fault, terms, leaves_out] :
       {Row{"starts_apart", "false_negatives", {"--starts-apart"}, true},
        Row{"nearest_time", "late_toi", {"--times", "estimates"}, false},
        Row{"nearest_time", "late_toi", {"--times", "none"}, false},
        Row{"faces_alone", "errors", {"--kinds", "vertex-face"}, true},
        Row{"single_precision", "false_negatives", {"--float-coordinates"}, true}}) {
    const Json before = certify(plugin, {"--exact"});
    EXPECT_EQ(before.at("status"), 1) << plugin;
    EXPECT_GT(before.at(fault), 0) << plugin;
    EXPECT_EQ(before.at("outside"), 0) << plugin;

    Words exact = terms;
    exact.emplace_back("--exact");
    const Json after = certify(plugin, exact);
    EXPECT_EQ(after.at("status"), 0) << plugin;
    EXPECT_EQ(all_faults(after), 0U) << plugin;
    EXPECT_EQ(after.at("outside") > 0, leaves_out) << plugin;
    EXPECT_EQ(after.at("queries").get<std::uint64_t>() + after.at("outside").get<std::uint64_t>(),
              before.at("queries").get<std::uint64_t>());
    EXPECT_EQ(tests::contains(out, "not asked: " + plugin), leaves_out) << out;
  }
}

/// The templates of examples/plugin/templates around a solver that is right.
TEST_F(Terms, OfTheTemplatesAreThoseOfTheirSolvers) {
  for (const std::string name : {"estimated_time", "interleaved", "single_precision",
                                 "verdict_alone", "vertex_face_alone"}) {
    const Json judged = certify("template_" + name, {"--exact"});
    EXPECT_EQ(judged.at("status"), 0) << name;
    EXPECT_EQ(all_faults(judged), 0U) << name;
    EXPECT_GT(judged.at("queries"), 0) << name;
  }
  // A test of boxes has false positives.
  const Json judged = certify("template_cuda_on_host", {});
  EXPECT_EQ(judged.at("status"), 0);
  EXPECT_EQ(judged.at("terms"), " --kinds vertex-face --float-coordinates --times none");
}

TEST_F(Terms, AnUlpIsToldFromATimeThatIsMuchTooLate) {
  const Json slight = certify("nearest_time", {}, {falling_from(1, 0)});
  EXPECT_EQ(slight.at("late_toi"), 1);
  EXPECT_EQ(slight.at("late").at("beyond"), Json({0, 0, 0, 0}));
  EXPECT_EQ(slight.at("late").at("greatest_ulps"), 1.0);
  for (const Words& terms : {Words{}, Words{"--times", "estimates"}}) {
    const Json much = certify("nearest_time", terms, {falling_from(7)});
    EXPECT_EQ(much.at("status"), 1);
    EXPECT_EQ(much.at("late_toi"), 1);
    EXPECT_EQ(much.at("late").at("beyond"), Json({1, 1, 1, 1}));
    EXPECT_NEAR(much.at("late").at("greatest").get<double>(), 0.3, 1e-9);
    EXPECT_TRUE(tests::contains(out, ", late by 3.0e-01, ")) << out;
  }
  // The estimate may be off as much.
  EXPECT_EQ(
      certify("nearest_time", {"--times", "estimates", "--time-error", "0.5"}, {falling_from(7)})
          .at("late_toi"),
      0);
}

/// Hangs are counted, not seconds: of queries at which a solver always hangs few are asked.
TEST_F(Terms, OfQueriesThatAlwaysHangFewAreAsked) {
  std::string rows;
  static_cast<void>(falling_from(1));
  for (int i = 0; i < 100; ++i) rows += read("vertex-face.csv");
  const Json judged = certify("hanging", {"--query-limit", "0.02", "--threads", "1"},
                              {write("vertex-face.csv", rows)});
  const auto hangs = judged.at("failures").at("hang").get<std::uint64_t>();
  EXPECT_EQ(judged.at("queries"), hangs);
  EXPECT_EQ(judged.at("left_out").get<std::uint64_t>() + hangs, 100U);
  EXPECT_EQ(judged.at("status"), 2);
  EXPECT_TRUE(tests::contains(out, " queries left out")) << out;
}

/// A solver that never answers takes nothing from the other, and the run says what it left out.
TEST_F(Terms, AHangingSolverTakesNoTimeFromTheOthers) {
  const tests::Outcome outcome =
      run({"certify", "--plugin", tests::plugin_library("hanging"), "--method", "certified",
           "--seconds", "3", "--count", "4", "--json", path("json")});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  const Json methods = json("json").at("methods");
  EXPECT_GT(methods.at(0).at("queries"), 0);
  EXPECT_GT(methods.at(1).at("left_out"), 0);
}

TEST_F(Terms, AreKeptByTheFuzzer) {
  const std::string plugin = tests::plugin_library("starts_apart");
  const Words words{"fuzz", "--plugin", plugin, "--queries", "3000", "--json", path("json")};
  EXPECT_EQ(run(words).status, 1);
  EXPECT_EQ(json("json").at("groups").at(0).at("what"), "false_negative");
  Words with_terms = words;
  with_terms.emplace_back("--starts-apart");
  EXPECT_EQ(run(with_terms).status, 0);
  const Json report = json("json");
  EXPECT_GT(report.at("outside"), 0);
  EXPECT_EQ(report.at("queries"), 3000);
  EXPECT_EQ(report.at("solver").at("terms"), " --starts-apart=0");
}

TEST_F(Terms, AreTakenByEveryCommandWithAPlugin) {
  for (const std::string command :
       {"certify", "solve", "fuzz", "stability", "bench", "report", "view"}) {
    const tests::Outcome outcome = run({command, "--help"});
    for (const char* const option :
         {"--kinds", "--starts-apart", "--float-coordinates", "--times", "--time-error"}) {
      EXPECT_TRUE(tests::contains(outcome.out, option)) << command << option;
    }
  }
}

}  // namespace
}  // namespace touchstone::verify::cli::terms_test

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/tool_test.hpp"
#include "tests/verify/solvers/plugins/misbehaviour.hpp"

// Tests of `touchstone curved --plugin`, which run the tool.

namespace touchstone::verify::cli::curved_command_test {
namespace {

using tests::contains;
using tests::Misbehaviour;
using tests::Outcome;
using tests::plugin_library;

class CurvedPlugins : public tests::ToolTest {
 protected:
  /// Judges a plugin on a file.
  [[nodiscard]] Outcome judge(const std::string& file, const std::string& plugin,
                              std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"curved", file, "--plugin", plugin_library(plugin)});
    options.insert(options.end(), {"--json", path("json")});
    return run(options);
  }

  /// The judgement on the plugin.
  [[nodiscard]] nlohmann::json judged() const {
    return json("json").at("sets").at(0).at("others").at(0);
  }

  /// A vertex that falls on a parabola to a face at t=1/2, and one that turns back at height 1/2.
  [[nodiscard]] std::string two_parabolas() const {
    return write("two-vf.csv", "degree,2\n" + parabola("1,1,", "-1") + parabola("1,1,", "0"));
  }

  /// The first parabola beside the face, but within its box.
  [[nodiscard]] std::string beside_the_face() const {
    return write("beside-vf.csv", "degree,2\n" + parabola("3,3,", "-1"));
  }

  /// Vertices that never come near the face, each of which selects an action.
  [[nodiscard]] std::string actions(const std::vector<Misbehaviour>& all) const {
    std::string text = "degree,2\n";
    for (const Misbehaviour action : all) {
      text += parabola(std::to_string(static_cast<int>(action)) + ",9,", "9");
    }
    return write("actions-vf.csv", text);
  }

 private:
  /// \param xy two coordinates of the vertex \param middle the height of its second control point
  static std::string parabola(const std::string& xy, const std::string& middle) {
    std::string text;
    for (const std::string& z : {std::string("1"), middle, std::string("1")}) {
      text += xy + z + "\n0,0,0\n4,0,0\n0,4,0\n";
    }
    return text;
  }
};

TEST_F(CurvedPlugins, AreJudgedRight) {
  const Outcome right = judge(two_parabolas(), "curved_sampling");
  EXPECT_EQ(right.status, 0) << right.err;
  EXPECT_TRUE(contains(right.out,
                       "  curved_sampling: 0 missed, 0 false, 0 late, 0 with an early upper bound, "
                       "0 failed, "))
      << right.out;
  EXPECT_EQ(judged().at("method"), "curved_sampling");
  EXPECT_EQ(judged().at("false_negatives"), 0);
  EXPECT_EQ(judged().at("keeps_promise"), true);
  EXPECT_EQ(judge(two_parabolas(), "curved_exact").status, 0);
}

/// A vertex with the weights 1 and 3 meets the face at t=1/4.
TEST_F(CurvedPlugins, ReceiveWeights) {
  const std::string file = write("rational-vf.csv",
                                 "rational,1\n1,1,1,1\n0,0,0,1\n4,0,0,1\n0,4,0,1\n"
                                 "1,1,-1,3\n0,0,0,1\n4,0,0,1\n0,4,0,1\n");
  const Outcome outcome = judge(file, "curved_sampling");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_EQ(json("json").at("sets").at(0).at("toi").at(0), 0.25);
  EXPECT_EQ(judged().at("false_negatives"), 0);
}

TEST_F(CurvedPlugins, MissContacts) {
  const Outcome missing = judge(two_parabolas(), "curved_missing");
  EXPECT_EQ(missing.status, 1) << missing.err;
  EXPECT_TRUE(contains(missing.out, "  curved_sampling: 1 missed, 0 false, 0 late")) << missing.out;
  EXPECT_TRUE(contains(missing.out,
                       "  query 0: curved_sampling: false negative: no, the truth is collision at "
                       "0.5\n"))
      << missing.out;
  EXPECT_EQ(judged().at("false_negatives"), 1);
  EXPECT_EQ(judged().at("keeps_promise"), false);
}

TEST_F(CurvedPlugins, AreLate) {
  const Outcome late = judge(two_parabolas(), "curved_late");
  EXPECT_EQ(late.status, 1) << late.err;
  EXPECT_EQ(judged().at("late"), 1);
  EXPECT_EQ(judged().at("false_negatives"), 0);
  EXPECT_EQ(judge(two_parabolas(), "curved_late", {"--times", "none"}).status, 0);
}

TEST_F(CurvedPlugins, MayHaveFalsePositivesUnlessTheyAreExact) {
  const Outcome conservative = judge(beside_the_face(), "curved_sampling");
  EXPECT_EQ(conservative.status, 0) << conservative.err;
  EXPECT_EQ(judged().at("false_positives"), 1);
  EXPECT_EQ(judge(beside_the_face(), "curved_exact").status, 1);
  EXPECT_EQ(judge(beside_the_face(), "curved_sampling", {"--exact"}).status, 1);
}

TEST_F(CurvedPlugins, PromiseNothing) {
  const Outcome outcome = judge(two_parabolas(), "curved_without_promise");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(judged().at("false_negatives"), 1);
}

/// Both vertices come within 1/2, at times that are sampled.
TEST_F(CurvedPlugins, ReceiveTheSeparation) {
  const Outcome near = judge(two_parabolas(), "curved_sampling", {"--min-separation", "0.5"});
  EXPECT_EQ(near.status, 0) << near.err;
  EXPECT_TRUE(contains(near.out, "2 queries, 2 collide")) << near.out;
  EXPECT_EQ(judged().at("false_negatives"), 0);
}

/// The vertex is at distance 1 from the face at t=0.
TEST_F(CurvedPlugins, AreNotAskedOutsideOfTheirTerms) {
  EXPECT_EQ(judge(two_parabolas(), "curved_missing", {"--starts-apart=0.5"}).status, 1);
  const Outcome outcome = judge(two_parabolas(), "curved_missing", {"--starts-apart=1"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "  curved_sampling: 2 not asked\n")) << outcome.out;
  EXPECT_EQ(judged().at("not_asked"), 2);
}

TEST_F(CurvedPlugins, FailAtSomeQueriesAlone) {
  const std::string file =
      actions({Misbehaviour::says_no, Misbehaviour::writes_to_null, Misbehaviour::throws,
               Misbehaviour::says_no, Misbehaviour::exits_with_3, Misbehaviour::prints});
  const Outcome outcome = judge(file, "misbehaving", {"--show-output"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(judged().at("failed"), 3);
  EXPECT_EQ(judged().at("false_positives"), 0);
  EXPECT_TRUE(contains(outcome.out, "query 2: misbehaving: error: exception: thrown by a plugin"))
      << outcome.out;
  EXPECT_TRUE(contains(outcome.err, "misbehaving: printed by a plugin")) << outcome.err;
}

/// A hang is a conservative yes, but one in three are too many.
TEST_F(CurvedPlugins, HangAtSomeQueriesAlone) {
  const std::string file =
      actions({Misbehaviour::says_no, Misbehaviour::hangs, Misbehaviour::says_no});
  const Outcome outcome = judge(file, "misbehaving", {"--query-limit", "0.1"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(judged().at("failed"), 1);
  EXPECT_EQ(judged().at("false_positives"), 1);
  EXPECT_EQ(judge(file, "misbehaving", {"--query-limit", "0.1", "--exact"}).status, 1);
}

TEST_F(CurvedPlugins, NeedTheFunctionForCurves) {
  const Outcome outcome = judge(two_parabolas(), "always_no");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "always_no.so: defines no touchstone_plugin_solve_curved"))
      << outcome.err;
}

/// The example: the boxes of all control points.
TEST_F(CurvedPlugins, KeepTheirPromiseOnTheFamilies) {
  const std::vector<std::string> words{"curved", "--count", "5", "--plugin",
                                       plugin_library("box_overlap")};
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "box_overlap: 0 missed, 5 false")) << outcome.out;
}

/// Sampling misses contacts of the families. Options of solvers are refused without a plugin.
TEST_F(CurvedPlugins, AreJudgedOnTheFamilies) {
  const Outcome outcome =
      run({"curved", "--count", "2", "--plugin", plugin_library("curved_missing"), "--plugin",
           plugin_library("curved_without_promise")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "curved_sampling: 2 missed")) << outcome.out;
  const Outcome refused = run({"curved", "--count", "2", "--query-limit", "1"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "--query-limit needs a solver")) << refused.err;
}

}  // namespace
}  // namespace touchstone::verify::cli::curved_command_test

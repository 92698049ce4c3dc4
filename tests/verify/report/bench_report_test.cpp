#include "verify/report/bench_report.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/judgements.hpp"

namespace touchstone::verify::report::bench_report_test {
namespace {

using fast::Promise;
using fast::Verdict;
using Words = std::vector<std::string>;

constexpr judge::GroundTruth miss{.index = 3, .collides = false, .toi = std::nullopt};
const judge::GroundTruth hit{.index = 4, .collides = true, .toi = exact::DoubleInterval{0.5, 0.5}};

jobs::SolverResult careful() {
  jobs::SolverResult careful;
  careful.name = "careful";
  careful.promise = Promise::exact;
  careful.queries = 400;
  careful.times.repetitions = {12.0, 10.0, 30.0};
  careful.singles = jobs::SingleTimes{.queries = 300, .p50 = 40.2, .p99 = 900.0, .max = 12345.0};
  careful.stages = {{"axis", 300}, {"exact", 100}};
  tests::add(careful.judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.25});
  tests::add(careful.judgement, miss, {.verdict = Verdict::no});
  return careful;
}

/// A solver that is wrong in each way, and not timed to the end.
jobs::SolverResult hasty() {
  jobs::SolverResult hasty;
  hasty.name = "hasty";
  hasty.promise = Promise::conservative;
  hasty.queries = 100;
  for (int i = 0; i < 23; ++i) tests::add(hasty.judgement, hit, {.verdict = Verdict::no});
  tests::add(hasty.judgement, miss, {.verdict = Verdict::undecided});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.75});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::yes, .toi_upper = 0.25});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::error});
  hasty.wrong_places.assign(hasty.judgement.wrong_answers.size(), {"b/edge-edge.csv", 17});
  return hasty;
}

BenchReport report() {
  BenchReport report;
  report.options.repetitions = 3;
  report.options.judge = 27;
  jobs::BenchResult& group = report.groups.emplace_back();
  group.name = "b";
  group.kind = Kind::edge_edge;
  group.queries = 400;
  group.judged = 27;
  group.collisions = 26;
  group.memory_pass.repetitions = {5.0, 4.0, 6.0};
  group.solvers = {careful(), hasty()};
  return report;
}

jobs::StepResult step() {
  jobs::StepResult step;
  step.name = "92-93";
  step.vertices = 10;
  step.edges = 30;
  step.faces = 20;
  step.vertex_face = {.candidates = 100, .collisions = 5};
  step.edge_edge = {.candidates = 300, .collisions = 7};
  step.times = {{.threads = 1,
                 .trees = {.wall = 0.25, .processor = 0.24},
                 .candidates = {.wall = 0.75, .processor = 0.74},
                 .collisions = {.wall = 0.5, .processor = 0.49},
                 .earliest = {.wall = 0.125, .processor = 0.12}},
                {.threads = 8,
                 .trees = {.wall = 0.03, .processor = 0.21},
                 .candidates = {.wall = 0.09, .processor = 0.65},
                 .collisions = {.wall = 0.07, .processor = 0.55},
                 .earliest = {.wall = 0.02, .processor = 0.15}}};
  step.earliest = fast::StepImpact{.toi_lower = 0.1, .toi_upper = 0.2, .pairs = {}};
  step.memory_pass = {.wall = 0.003, .processor = 0.002};
  return step;
}

std::vector<std::string> lines_of(const BenchReport& report) {
  std::istringstream text(to_text(report));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

Words words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(BenchReport, TextHasATableAGroup) {
  const auto lines = lines_of(report());
  ASSERT_GT(lines.size(), 5U);
  EXPECT_EQ(lines[0],
            "b, edge-edge: 400 queries, 26 collisions among 27 judged; memory pass 5.00 ns/query");
  EXPECT_EQ(words(lines[1])[0], "method");
  EXPECT_EQ(words(lines[2]),
            (Words{"careful", "12.0", "2.40", "40", "900", "12345", "400", "2", "0", "0", "0", "0",
                   "0", "0", "2.50e-01", "2.50e-01", "2.50e-01"}));
  EXPECT_EQ(lines[3], "  ended by: axis 75 %, exact 25 %");
  EXPECT_EQ(words(lines[4]), (Words{"hasty", "-", "-", "-", "-", "-", "100", "27", "23", "1", "1",
                                    "1", "1", "1", "2.50e-01", "2.50e-01", "2.50e-01"}));
}

TEST(BenchReport, TextNamesTheAnswersThatBrokeAPromise) {
  const auto lines = lines_of(report());
  EXPECT_EQ(
      lines[5],
      "false negative: hasty: b/edge-edge.csv: edge-edge query 17: answer no, truth collision "
      "at 0.5");
  EXPECT_EQ(lines[24], lines[5]);
  EXPECT_TRUE(lines[25].starts_with("late toi: hasty: b/edge-edge.csv")) << lines[25];
  EXPECT_TRUE(lines[26].starts_with("early toi_upper: hasty: ")) << lines[26];
  EXPECT_TRUE(lines[27].starts_with("error: hasty: ")) << lines[27];
  EXPECT_EQ(lines[28], "false negative: hasty: b: and 3 more");
  EXPECT_EQ(lines[29], "") << "a conservative method may be wrong about a miss";
}

TEST(BenchReport, TextSaysWhatWasSampledAndOnlyThen) {
  const auto says = [](const BenchReport& said, const std::string& word) {
    const std::string text = to_text(said);
    return text.find("\n" + word) != std::string::npos;
  };
  BenchReport sampled = report();
  EXPECT_TRUE(says(sampled, "timed: "));
  EXPECT_TRUE(says(sampled, "judged: "));
  sampled.groups[0].solvers[1].queries = 400;
  sampled.groups[0].judged = 400;
  EXPECT_FALSE(says(sampled, "timed: "));
  EXPECT_FALSE(says(sampled, "judged: "));
  EXPECT_EQ(lines_of(sampled)[0],
            "b, edge-edge: 400 queries, 26 collisions; memory pass 5.00 ns/query");
}

TEST(BenchReport, TextShowsNamesOnOneLine) {
  BenchReport named = report();
  named.groups[0].name = "x\x1b[2J\nmethod\u202e";
  named.step = step();
  named.step->name = "y\n\u2028";
  const std::string text = to_text(named);
  EXPECT_NE(text.find("x\\x1b[2J\\x0amethod\\xe2\\x80\\xae, edge-edge: "), std::string::npos)
      << text;
  EXPECT_NE(text.find("\ny\\x0a\\xe2\\x80\\xa8: 10 vertices"), std::string::npos) << text;
}

TEST(BenchReport, TextHasTheStep) {
  BenchReport stepped;
  stepped.step = step();
  const auto lines = lines_of(stepped);
  ASSERT_GE(lines.size(), 8U);
  EXPECT_EQ(lines[0],
            "92-93: 10 vertices, 30 edges, 20 faces; vertex-face 100 candidates, 5 collisions; "
            "edge-edge 300 candidates, 7 collisions; memory pass 2.000 ms");
  EXPECT_EQ(lines[1], "earliest impact between 0.1 and 0.2");
  EXPECT_EQ(words(lines[3]), (Words{"1", "wall", "250.0", "ms", "750.0", "ms", "500.0", "ms",
                                    "125.0", "ms", "750.0", "ms", "375.0", "ms"}));
  EXPECT_EQ(words(lines[4]), (Words{"1", "processor", "240.0", "ms", "740.0", "ms", "490.0", "ms",
                                    "120.0", "ms", "730.0", "ms", "360.0", "ms"}));
  EXPECT_EQ(words(lines[5])[0], "8");
  EXPECT_EQ(words(lines[6])[1], "processor");
  static constexpr auto legend = "wall is the time from beginning to end, processor\n";
  EXPECT_NE(to_text(stepped).find(legend), std::string::npos);
  EXPECT_EQ(to_text(report()).find(legend), std::string::npos);
}

TEST(BenchReport, WrongAnswersAreBrokenPromisesAndContradictions) {
  BenchReport right = report();
  EXPECT_TRUE(has_wrong_answers(right));
  right.groups[0].solvers.pop_back();
  EXPECT_FALSE(has_wrong_answers(right));
  right.step = step();
  EXPECT_FALSE(has_wrong_answers(right));
  right.step->earliest_agrees = false;
  EXPECT_TRUE(has_wrong_answers(right));
  EXPECT_NE(to_text(right).find("NOT that of the collisions"), std::string::npos);
}

TEST(BenchReport, JsonHasGroupsAndMethods) {
  const nlohmann::json json = to_json(report());
  EXPECT_EQ(json.at("repetitions"), 3);
  EXPECT_EQ(json.at("seconds"), 2.0);
  EXPECT_EQ(json.at("judge"), 27);
  EXPECT_TRUE(json.at("step").is_null());
  ASSERT_EQ(json.at("groups").size(), 1U);
  const nlohmann::json& group = json.at("groups")[0];
  EXPECT_EQ(group.at("name"), "b");
  EXPECT_EQ(group.at("kind"), "edge-edge");
  EXPECT_EQ(group.at("queries"), 400);
  EXPECT_EQ(group.at("judged"), 27);
  EXPECT_EQ(group.at("collisions"), 26);
  EXPECT_EQ(group.at("interrupted"), false);
  EXPECT_EQ(group.at("memory_pass"), (nlohmann::json{{"ns_per_query", 5.0},
                                                     {"min_ns_per_query", 4.0},
                                                     {"repetitions", {5.0, 4.0, 6.0}}}));
  ASSERT_EQ(group.at("methods").size(), 2U);
  const nlohmann::json& first = group.at("methods")[0];
  EXPECT_EQ(first.at("name"), "careful");
  EXPECT_EQ(first.at("promise"), "exact");
  EXPECT_EQ(first.at("queries"), 400);
  EXPECT_EQ(first.at("time").at("ns_per_query"), 12.0);
  EXPECT_EQ(first.at("passes"), 12.0 / 5.0);
  EXPECT_EQ(
      first.at("single"),
      (nlohmann::json{{"queries", 300}, {"p50_ns", 40.2}, {"p99_ns", 900.0}, {"max_ns", 12345.0}}));
  EXPECT_EQ(first.at("stages"), (nlohmann::json{{"axis", 300}, {"exact", 100}}));
  EXPECT_EQ(first.at("judged"), 2);
  EXPECT_EQ(first.at("toi_error"), (nlohmann::json{{"count", 1},
                                                   {"p50", 0.25},
                                                   {"p90", 0.25},
                                                   {"p99", 0.25},
                                                   {"max", 0.25},
                                                   {"histogram", {{65345, 1}}}}));
  EXPECT_EQ(first.at("broke_promise"), false);
  EXPECT_TRUE(first.at("wrong_answers").empty());
}

TEST(BenchReport, JsonHasWhatIsWrongAndNullForWhatIsUnknown) {
  const nlohmann::json json = to_json(report());
  const nlohmann::json& second = json.at("groups")[0].at("methods")[1];
  EXPECT_TRUE(second.at("time").at("ns_per_query").is_null());
  EXPECT_TRUE(second.at("passes").is_null());
  EXPECT_TRUE(second.at("single").is_null());
  EXPECT_TRUE(second.at("stages").is_null());
  EXPECT_EQ(second.at("false_negatives"), 23);
  EXPECT_EQ(second.at("broke_promise"), true);
  ASSERT_EQ(second.at("wrong_answers").size(), 27U) << "false positives too";
  EXPECT_EQ(second.at("wrong_answers")[0], (nlohmann::json{{"source", "b/edge-edge.csv"},
                                                           {"index", 17},
                                                           {"fault", "false negative"},
                                                           {"answer", "no"},
                                                           {"truth", "collision at 0.5"}}));
}

TEST(BenchReport, JsonHasTheStep) {
  BenchReport stepped;
  stepped.step = step();
  const nlohmann::json json = to_json(stepped).at("step");
  EXPECT_EQ(json.at("name"), "92-93");
  EXPECT_EQ(json.at("vertices"), 10);
  EXPECT_EQ(json.at("edges"), 30);
  EXPECT_EQ(json.at("faces"), 20);
  EXPECT_EQ(json.at("vertex_face"), (nlohmann::json{{"candidates", 100}, {"collisions", 5}}));
  EXPECT_EQ(json.at("edge_edge"), (nlohmann::json{{"candidates", 300}, {"collisions", 7}}));
  EXPECT_EQ(json.at("earliest"), (nlohmann::json{{"toi_lower", 0.1}, {"toi_upper", 0.2}}));
  EXPECT_EQ(json.at("earliest_agrees"), true);
  EXPECT_EQ(json.at("interrupted"), false);
  EXPECT_EQ(json.at("memory_pass_s"), 0.002);
  ASSERT_EQ(json.at("times").size(), 2U);
  EXPECT_EQ(json.at("times")[1], (nlohmann::json{{"threads", 8},
                                                 {"trees_s", 0.03},
                                                 {"candidates_s", 0.09},
                                                 {"collisions_s", 0.07},
                                                 {"earliest_s", 0.02},
                                                 {"trees_processor_s", 0.21},
                                                 {"candidates_processor_s", 0.65},
                                                 {"collisions_processor_s", 0.55},
                                                 {"earliest_processor_s", 0.15}}));
  stepped.step->earliest.reset();
  EXPECT_TRUE(to_json(stepped).at("step").at("earliest").is_null());
}

TEST(BenchReport, NamesTheSeparationWhereThereIsOne) {
  BenchReport separated = report();
  separated.step = step();
  EXPECT_EQ(to_text(separated).find("separation"), std::string::npos);
  EXPECT_EQ(to_json(separated).dump().find("separation"), std::string::npos);
  separated.groups[0].separation = {.distance = 0.5, .norm = Norm::l2};
  separated.step->separation = {.distance = 0.25};
  EXPECT_NE(to_text(separated).find("b, edge-edge, minimum separation 0.5 (l2): 400 queries"),
            std::string::npos);
  EXPECT_NE(to_text(separated).find("92-93, minimum separation 0.25 (linf): 10 vertices"),
            std::string::npos);
  EXPECT_EQ(to_json(separated).at("groups")[0].at("separation").at("min_separation"), 0.5);
  EXPECT_EQ(to_json(separated).at("step").at("separation").at("norm"), "linf");
}

}  // namespace
}  // namespace touchstone::verify::report::bench_report_test

#include "verify/report/certify_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/judgements.hpp"
#include "tests/support/queries.hpp"

namespace touchstone::verify::report::certify_report_test {
namespace {

std::vector<jobs::CertifyResult> results() {
  jobs::CertifyResult clean;
  clean.name = "a/vertex-face.csv";
  clean.kind = Kind::vertex_face;
  clean.queries = 8;
  clean.collisions = 3;
  clean.labels = 8;
  clean.microseconds = 16.0;
  jobs::CertifyResult wrong;
  wrong.name = "b,c/edge-edge.csv";
  wrong.kind = Kind::edge_edge;
  wrong.queries = 2;
  wrong.collisions = 2;
  wrong.labels = 2;
  wrong.label_mismatches = 1;
  wrong.tois = 1;
  wrong.toi_mismatches = 1;
  wrong.skipped = 4;
  wrong.rounded = 9;
  wrong.microseconds = 34.0;
  wrong.mismatches = {{judge::Mismatch::Of::label, 0, "no collision", "collision"},
                      {judge::Mismatch::Of::toi, 1, "2.5E-1", "5E-1"}};
  wrong.fail("b,c/edge-edge.csv:17:3: denominator is zero");
  return {clean, wrong};
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(CertifyReport, TextHasARowASourceTheTotalAndEachMismatch) {
  std::istringstream text(to_text(results()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 8U);
  using Words = std::vector<std::string>;
  EXPECT_EQ(words(lines[1]),
            (Words{"a/vertex-face.csv", "vertex-face", "8", "3", "8", "0", "0", "0", "2.00"}));
  EXPECT_EQ(words(lines[2]),
            (Words{"b,c/edge-edge.csv", "edge-edge", "2", "2", "2", "1", "1", "1", "17.00"}));
  EXPECT_EQ(words(lines[3]), (Words{"total", "10", "5", "10", "1", "1", "1", "5.00"}));
  EXPECT_EQ(lines[4], "4 queries in error skipped");
  EXPECT_EQ(lines[5], "9 coordinates rounded to double");
  EXPECT_EQ(lines[6],
            "mismatch: b,c/edge-edge.csv: edge-edge query 0: recorded label no collision, truth "
            "collision");
  EXPECT_EQ(lines[7],
            "mismatch: b,c/edge-edge.csv: edge-edge query 1: recorded toi 2.5E-1, truth 5E-1");
}

TEST(CertifyReport, TextShowsNamesOnOneLine) {
  std::vector<jobs::CertifyResult> named = results();
  named[1].name = "x\x1b[2J\ntotal 9\u202e";
  const std::string text = to_text(named);
  EXPECT_NE(text.find("\nx\\x1b[2J\\x0atotal 9\\xe2\\x80\\xae  edge-edge "), std::string::npos)
      << text;
  EXPECT_NE(text.find("mismatch: x\\x1b[2J\\x0atotal 9\\xe2\\x80\\xae: edge-edge query 0"),
            std::string::npos);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find("\ntotal 9"), std::string::npos);
}

TEST(CertifyReport, JsonHasTotalFilesAndMismatches) {
  const nlohmann::json json = to_json(results());
  EXPECT_EQ(json.at("queries"), 10);
  EXPECT_EQ(json.at("collisions"), 5);
  EXPECT_EQ(json.at("label_mismatches"), 1);
  EXPECT_EQ(json.at("toi_mismatches"), 1);
  EXPECT_EQ(json.at("skipped"), 4);
  EXPECT_EQ(json.at("rounded"), 9);
  EXPECT_EQ(json.at("errors"), 1);
  EXPECT_EQ(json.at("us_per_query"), 5.0);
  EXPECT_EQ(json.at("interrupted"), false);
  ASSERT_EQ(json.at("files").size(), 2U);
  EXPECT_EQ(json.at("files")[0].at("file"), "a/vertex-face.csv");
  EXPECT_EQ(json.at("files")[0].at("us_per_query"), 2.0);
  EXPECT_FALSE(json.at("files")[0].contains("error"));
  EXPECT_EQ(json.at("files")[1].at("kind"), "edge-edge");
  EXPECT_EQ(json.at("files")[1].at("error"), "b,c/edge-edge.csv:17:3: denominator is zero");
  ASSERT_EQ(json.at("mismatches").size(), 2U);
  EXPECT_EQ(json.at("mismatches")[1], (nlohmann::json{{"file", "b,c/edge-edge.csv"},
                                                      {"index", 1},
                                                      {"kind", "edge-edge"},
                                                      {"of", "toi"},
                                                      {"recorded", "2.5E-1"},
                                                      {"truth", "5E-1"}}));
}

TEST(CertifyReport, JsonHasTheProofsWhereThereAreAny) {
  std::vector<jobs::CertifyResult> proved = results();
  EXPECT_FALSE(to_json(proved).contains("proofs"));
  for (jobs::CertifyResult& result : proved) result.proofs = {.no_collision = 3, .bytes = 70};
  EXPECT_EQ(to_json(proved).at("proofs").at("no_collision"), 6);
  EXPECT_EQ(to_json(proved).at("proofs").at("bytes"), 140);
}

TEST(CertifyReport, NothingGivesAnEmptyReport) {
  const nlohmann::json json = to_json(std::vector<jobs::CertifyResult>());
  EXPECT_EQ(json.at("queries"), 0);
  EXPECT_EQ(json.at("us_per_query"), 0.0);
  EXPECT_TRUE(json.at("mismatches").is_array());
}

// ---- Solvers ------------------------------------------------------------------------------------

using fast::Answer;
using fast::Promise;
using fast::Verdict;

constexpr judge::GroundTruth miss{.index = 3, .collides = false, .toi = std::nullopt};
const judge::GroundTruth hit{.index = 4, .collides = true, .toi = exact::DoubleInterval{0.5, 0.5}};

/// A source for which `careful` is right and `hasty` wrong in each way, and one for which both are
/// right.
std::vector<jobs::CertifyResult> judged_results(Promise promise_of_hasty) {
  jobs::MethodResult careful{
      .name = "careful", .promise = Promise::exact, .timed = true, .judgement = {}};
  jobs::MethodResult hasty{
      .name = "hasty", .promise = promise_of_hasty, .timed = false, .judgement = {}};
  tests::add(careful.judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.25});
  careful.judgement.nanoseconds = 12.5;
  tests::add(hasty.judgement, hit, {.verdict = Verdict::yes});
  std::vector<jobs::CertifyResult> all = results();
  all[0].methods = {careful, hasty};
  for (int i = 0; i < 23; ++i) tests::add(hasty.judgement, hit, {.verdict = Verdict::no});
  tests::add(hasty.judgement, miss, {.verdict = Verdict::yes});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.75});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::yes, .toi_upper = 0.25});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::undecided});
  tests::add(hasty.judgement, hit, {.verdict = Verdict::error});
  hasty.judgement.add_unasked(judge::Unasked::missing, 9);
  all[1].methods = {careful, hasty};
  return all;
}

std::vector<std::string> method_lines(const std::vector<jobs::CertifyResult>& judged) {
  std::istringstream text(to_text(judged));
  std::vector<std::string> lines;
  bool seen = false;
  for (std::string line; std::getline(text, line);) {
    seen = seen || line.starts_with("method ");
    if (seen) lines.push_back(line);
  }
  return lines;
}

TEST(CertifyReport, TextHasTheTotalOfEachMethodAndWhereItBrokeItsPromise) {
  using Words = std::vector<std::string>;
  const auto lines = method_lines(judged_results(Promise::conservative));
  ASSERT_EQ(lines.size(), 6U + 20 + 1 + 3);
  EXPECT_EQ(words(lines[1]), (Words{"careful", "2", "0", "0", "0", "0", "0", "0", "12.5",
                                    "2.50e-01", "2.50e-01", "2.50e-01"}));
  EXPECT_EQ(words(lines[2]), (Words{"hasty", "30", "23", "1", "1", "1", "1", "1", "-", "2.50e-01",
                                    "2.50e-01", "2.50e-01"}));
  EXPECT_EQ(words(lines[3]), (Words{"b,c/edge-edge.csv", "edge-edge", "29", "23", "1", "1", "1",
                                    "1", "1", "-", "2.50e-01", "2.50e-01", "2.50e-01"}));
  EXPECT_EQ(lines[4], "no answer: hasty: 1 no_verdict, 1 undecided");
  EXPECT_EQ(lines[5],
            "times of impact: hasty: 1 late, 1 by more than 1e-12, 1 by more than 1e-09, 1 by more "
            "than 1e-06, 1 by more than 1e-03; at most by 2.50e-01 of the step, 2251799813685248 "
            "ulp");
  EXPECT_EQ(lines[6],
            "false negative: hasty: b,c/edge-edge.csv: edge-edge query 4: answer no, truth "
            "collision at 0.5");
  EXPECT_EQ(lines[25], lines[6]);
  EXPECT_EQ(lines[26],
            "late toi: hasty: b,c/edge-edge.csv: edge-edge query 4: answer toi_lower 0.75, truth "
            "collision at 0.5, late by 2.5e-01, 2251799813685248 ulp");
  EXPECT_EQ(lines[29], "false negative: hasty: b,c/edge-edge.csv: and 3 more");
}

TEST(CertifyReport, WithoutSolversThereIsNoTable) {
  EXPECT_TRUE(method_lines(results()).empty());
  EXPECT_EQ(to_json(results()).at("methods"), nlohmann::json::array());
}

TEST(CertifyReport, JsonHasTheMethodsOfTheTotalAndOfEachFile) {
  const nlohmann::json json = to_json(judged_results(Promise::conservative));
  ASSERT_EQ(json.at("methods").size(), 2U);
  nlohmann::json careful = json.at("methods")[0], hasty = json.at("methods")[1];
  careful.at("toi_error").erase("histogram");
  nlohmann::json no_failures;
  for (const judge::Fault kind : judge::all_failures) no_failures[judge::to_string(kind)] = 0;
  EXPECT_EQ(
      careful,
      (nlohmann::json{
          {"name", "careful"},
          {"promise", "exact"},
          {"terms", ""},
          {"queries", 2},
          {"outside", 0},
          {"left_out", 0},
          {"late",
           {{"count", 0}, {"beyond", {0, 0, 0, 0}}, {"greatest", 0.0}, {"greatest_ulps", 0.0}}},
          {"false_negatives", 0},
          {"false_positives", 0},
          {"late_toi", 0},
          {"early_toi_upper", 0},
          {"undecided", 0},
          {"errors", 0},
          {"failures", no_failures},
          {"unplaced_crashes", 0},
          {"beyond_tolerance", 0},
          {"missing", 0},
          {"ns_per_query", 12.5},
          {"toi_error", {{"count", 2}, {"p50", 0.25}, {"p90", 0.25}, {"p99", 0.25}, {"max", 0.25}}},
          {"wrong_answers", nlohmann::json::array()}}));
  EXPECT_EQ(hasty.at("queries"), 30);
  EXPECT_EQ(hasty.at("false_negatives"), 23);
  EXPECT_EQ(hasty.at("failures").at("no_verdict"), 1);
  EXPECT_EQ(hasty.at("failures").at("undecided"), 1);
  EXPECT_EQ(hasty.at("missing"), 1);
  EXPECT_TRUE(hasty.at("ns_per_query").is_null());
  ASSERT_EQ(hasty.at("wrong_answers").size(), 27U) << "false positives too";
  EXPECT_EQ(hasty.at("wrong_answers")[0], (nlohmann::json{{"file", "b,c/edge-edge.csv"},
                                                          {"index", 4},
                                                          {"kind", "edge-edge"},
                                                          {"fault", "false negative"},
                                                          {"answer", "no"},
                                                          {"truth", "collision at 0.5"}}));
  EXPECT_EQ(json.at("files")[0].at("methods")[1].at("queries"), 1);
  EXPECT_TRUE(json.at("files")[0].at("methods")[1].at("toi_error").is_null());
  EXPECT_EQ(json.at("files")[1].at("methods")[1].at("queries"), 29);
}

// ---- Separations --------------------------------------------------------------------------------

constexpr Separation near{.distance = 1e-8, .norm = Norm::l2};

std::vector<jobs::CertifyResult> separated_results() {
  std::vector<jobs::CertifyResult> all = judged_results(Promise::conservative);
  for (jobs::CertifyResult& result : all) result.separation = near;
  return all;
}

TEST(CertifyReport, TextNamesTheSeparationAndWhatIsCompared) {
  std::vector<jobs::CertifyResult> all = separated_results();
  EXPECT_TRUE(to_text(all).starts_with("minimum separation 1e-08 (l2)\nfile "));
  all[1].compared = judge::Inference::collisions;
  EXPECT_TRUE(to_text(all).starts_with(
      "minimum separation 1e-08 (l2)\nrecorded answers are about less separation: only their "
      "collisions are compared, which must collide, no later\nfile "));
  all[1].separation.norm = Norm::linf;
  EXPECT_TRUE(
      to_text(all).starts_with("minimum separation 1e-08 (l2): a/vertex-face.csv\n"
                               "minimum separation 1e-08 (linf): b,c/edge-edge.csv\n"));
}

TEST(CertifyReport, JsonHasTheSeparationOfFilesAndOfTheTotalIfItIsOne) {
  std::vector<jobs::CertifyResult> all = separated_results();
  EXPECT_EQ(to_json(all).at("separation").dump(), R"({"min_separation":1e-08,"norm":"l2"})");
  EXPECT_EQ(to_json(all).at("files")[1].at("compared"), "all");
  all[1].separation.norm = Norm::linf;
  EXPECT_FALSE(to_json(all).contains("separation"));
  EXPECT_EQ(to_json(all).at("files")[1].at("separation").at("norm"), "linf");
}

TEST(CertifyReport, TolerancesHaveAColumnWithASeparationOrAFault) {
  std::vector<jobs::CertifyResult> all = separated_results();
  const Query apart = tests::over_triangle(1, 1, 1, 1).query;
  all[0].methods[0].judgement.add({Kind::vertex_face, apart}, miss,
                                  {.verdict = Verdict::yes, .tolerance = 0.5}, {});
  const auto lines = method_lines(all);
  EXPECT_TRUE(lines[0].ends_with("  beyond tol"));
  EXPECT_EQ(words(lines[1]).back(), "1");
  EXPECT_EQ(words(lines[3]).back(), "0");
  EXPECT_EQ(lines[0].size(), lines[1].size());
  const auto fault = std::ranges::find_if(
      lines, [](const std::string& line) { return line.starts_with("beyond tolerance: "); });
  ASSERT_NE(fault, lines.end());
  EXPECT_EQ(*fault,
            "beyond tolerance: careful: a/vertex-face.csv: vertex-face query 3: answer yes, "
            "tolerance 0.5, truth no collision");
  EXPECT_EQ(to_json(all).at("methods")[0].at("beyond_tolerance"), 1);
  EXPECT_EQ(to_json(all).at("methods")[1].at("beyond_tolerance"), 0);
  for (jobs::CertifyResult& result : all) result.separation = {};
  EXPECT_TRUE(method_lines(all)[0].ends_with("  beyond tol"));
  all = judged_results(Promise::none);
  EXPECT_FALSE(method_lines(all)[0].ends_with("  beyond tol"));
  EXPECT_EQ(to_json(all).at("methods")[0].at("beyond_tolerance"), 0);
}

TEST(CertifyReport, TruthIsCsvWhoseDoublesComeBack) {
  const double lower = 0.1, upper = std::nextafter(0.1, 1.0);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(truth_header(), "file,index,kind,collides,toi_lower,toi_upper\n");
  EXPECT_EQ(truth_row("plain.csv", Kind::vertex_face,
                      {.index = 0, .collides = false, .toi = std::nullopt}),
            "plain.csv,0,vertex-face,0,,\n");
  EXPECT_EQ(truth_row("with,comma \"and quotes\"", Kind::edge_edge,
                      {.index = 7, .collides = true, .toi = exact::DoubleInterval{lower, upper}}),
            "\"with,comma \"\"and quotes\"\"\",7,edge-edge,1,0.1,0.10000000000000002\n");
  EXPECT_EQ(truth_row("tiny", Kind::edge_edge,
                      {.index = 8, .collides = true, .toi = exact::DoubleInterval{0.0, least}}),
            "tiny,8,edge-edge,1,0,5e-324\n");
  EXPECT_EQ(std::stod("0.10000000000000002"), upper);
}

}  // namespace
}  // namespace touchstone::verify::report::certify_report_test

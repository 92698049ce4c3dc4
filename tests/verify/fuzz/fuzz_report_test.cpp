#include "verify/fuzz/fuzz_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/queries.hpp"

namespace touchstone::verify::fuzz::fuzz_report_test {
namespace {

FuzzReport sample() {
  FuzzReport report;
  report.solver = {.method = "mine",
                   .plugin = "/tmp/mine.so",
                   .promise = fast::Promise::exact,
                   .options = {.tolerance = 0.25,
                               .max_checks = 9,
                               .separation = {.distance = 0.5, .norm = Norm::l2}},
                   .query_limit_seconds = 3.0};
  report.seed = 7;
  report.seconds = 2.0;
  report.result.queries = 3000;
  report.result.images = 300;
  report.result.collisions = 1000;
  report.result.judged_by_oracle = 40;
  report.result.seconds = 2.0;
  report.result.method_seconds = 1.25;
  report.result.shrink_seconds = 0.25;
  report.result.other_seconds = 0.5;
  report.result.all_findings = 12;
  report.result.generators = {
      {.name = "grid", .queries = 3000, .collisions = 1000, .coverage_keys = 20, .findings = 12}};
  Finding finding;
  finding.what = judge::Fault::late_toi;
  finding.separation = {.distance = 0.5, .norm = Norm::l2};
  finding.method = "mine";
  finding.original = {.query = tests::over_triangle(1, 1, 1.25, -3).query,
                      .answer = {.verdict = fast::Verdict::yes, .toi_lower = 0.625},
                      .collides = true,
                      .truth = "collision at 0.375",
                      .detail = "toi_lower 0.625 is late",
                      .certificate = "original certificate"};
  finding.simplest = {.query = tests::over_triangle(1, 1, 1, -2).query,
                      .answer = {.verdict = fast::Verdict::yes, .toi_lower = 0.75},
                      .collides = true,
                      .truth = "collision at 0.5",
                      .detail = "toi_lower 0.75 is late",
                      .certificate = "certificate"};
  finding.shrinking = Shrinking::complete;
  finding.seconds = 1.25;
  finding.queries = 1234;
  finding.generator = "grid";
  report.result.findings = {finding};
  report.result.groups = {{.count = 12, .best = 0}};
  return report;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FuzzReport, SaysAFindingInALine) {
  EXPECT_EQ(to_line(sample().result.findings.front()),
            "late_toi of mine, vertex-face at minimum separation 0.5 (l2): toi_lower 0.75 is late");
}

/// The best example of each group, with its own truth, in ten lines; the commands are in files.
TEST(FuzzReport, ShowsAGroupByItsBestExample) {
  FuzzReport report = sample();
  const std::string text = to_text(report);
  const std::vector<std::string> order{"12 findings, in 1 groups",
                                       "group  finding",
                                       "    1  late_toi               12  any scale",
                                       "group 1: late_toi of mine, vertex-face",
                                       "truth: collision at 0.5",
                                       "not asked at other scales",
                                       "v    (1, 1, 1) → (1, 1, -2)",
                                       "f2   (0, 4, 0) → (0, 4, 0)"};
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_TRUE(contains(text, order[i])) << order[i] << '\n' << text;
    if (i != 0) {
      EXPECT_LT(text.find(order[i - 1]), text.find(order[i])) << order[i] << '\n' << text;
    }
  }
  EXPECT_FALSE(contains(text, "TEST("));
  EXPECT_FALSE(contains(text, "the time was over"));
  report.result.findings.front().shrinking = Shrinking::cut_short;
  EXPECT_TRUE(contains(to_text(report), "the time was over"));
  report.result.findings.front().shrinking = Shrinking::not_reproduced;
  EXPECT_TRUE(contains(to_text(report), "asked alone, it is not wrong"));
}

TEST(FuzzReport, SaysAtWhatScalesAFindingIsWrong) {
  const SolverCall asked{.method = "mine", .options = {.tolerance = 0x1p-20}};
  Finding finding;
  EXPECT_EQ(scale_text(finding, asked), "not asked at other scales");
  finding.shrinking = Shrinking::complete;
  EXPECT_EQ(scale_text(finding, asked), "wrong at any scale from 2^-16 to 2^40");
  finding.scales.end_above = -2;
  EXPECT_EQ(scale_text(finding, asked), "wrong while the greatest coordinate is below 2^-2");
  finding.scales.end_below = -9;
  EXPECT_EQ(scale_text(finding, asked),
            "wrong while the greatest coordinate is above 2^-8 and below 2^-2");
  finding.scales.end_above.reset();
  EXPECT_EQ(scale_text(finding, asked), "wrong while the greatest coordinate is above 2^-8");
}

TEST(FuzzReport, SaysTheNumbersOfARun) {
  FuzzReport report = sample();
  const std::string text = to_text(report);
  for (const std::string part :
       {"mine (exact), seed 7, minimum separation 0.5 (l2): 3000 queries in 2.0 s", "300 of them",
        "1500 queries a second, 6000 without the method's own time; 40 judged"}) {
    EXPECT_TRUE(contains(text, part)) << text;
  }
  report.result.findings.clear();
  report.result.groups.clear();
  report.result.all_findings = 0;
  EXPECT_TRUE(contains(to_text(report), "no findings"));
}

TEST(FuzzReport, SaysIfLessWasDoneThanAskedFor) {
  FuzzReport report = sample();
  EXPECT_FALSE(contains(to_text(report), "ended by the time"));
  EXPECT_FALSE(contains(to_text(report), "too late"));
  EXPECT_FALSE(contains(to_text(report), "not answered"));
  report.result.unanswered = 30;
  EXPECT_TRUE(contains(to_text(report), "30 queries more were asked, and not answered in time"));
  EXPECT_EQ(to_json(report).at("unanswered"), 30);
  report.queries = 5000;
  EXPECT_TRUE(contains(to_text(report), "ended by the time: 3000 of 5000 queries judged in 2 s"));
  report.result.unjudged = 256;
  EXPECT_TRUE(contains(to_text(report), "256 queries more were answered, too late to be judged"));
  report.result.ended_by = FuzzEnd::findings;
  EXPECT_FALSE(contains(to_text(report), "ended by the time"));
  EXPECT_FALSE(contains(to_text(report), "too late"));
}

TEST(FuzzReport, SaysIfFindingsWereNotSought) {
  FuzzReport report = sample();
  EXPECT_FALSE(contains(to_text(report), "not sought"));
  report.only = {judge::Fault::late_toi};
  report.result.other_findings = 53;
  EXPECT_TRUE(contains(to_text(report), "53 of kinds that were not sought"));
  EXPECT_EQ(to_json(report).at("other_findings"), 53);
  EXPECT_EQ(to_json(report).at("asked").at("only"), nlohmann::json({"late_toi"}));
}

TEST(FuzzReport, WritesAllAsJson) {
  const nlohmann::json json = to_json(sample());
  EXPECT_EQ(json.at("method"), "mine");
  EXPECT_EQ(json.at("promise"), "exact");
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_EQ(json.at("separation").at("norm"), "l2");
  EXPECT_EQ(json.at("asked").at("seconds"), 2.0);
  EXPECT_TRUE(json.at("asked").at("queries").is_null());
  EXPECT_TRUE(json.at("asked").at("only").empty());
  EXPECT_EQ(json.at("other_findings"), 0);
  EXPECT_EQ(json.at("ended_by"), "time");
  EXPECT_EQ(json.at("unjudged"), 0);
  EXPECT_EQ(json.at("shrink_seconds"), 0.25);
  EXPECT_EQ(json.at("queries_per_second"), 1500.0);
  EXPECT_EQ(json.at("judged_per_second"), 6000.0);
  EXPECT_EQ(json.at("all_findings"), 12);
  EXPECT_EQ(json.at("interrupted"), false);
  EXPECT_EQ(json.at("generators").at(0).at("coverage_keys"), 20);
  for (const nlohmann::json& solver : {json.at("solver"), json.at("findings").at(0).at("solver")}) {
    EXPECT_EQ(solver.at("plugin"), "/tmp/mine.so");
    EXPECT_EQ(solver.at("tolerance"), 0.25);
    EXPECT_EQ(solver.at("max_checks"), 9);
    EXPECT_EQ(solver.at("min_separation"), 0.5);
    EXPECT_EQ(solver.at("norm"), "l2");
    EXPECT_EQ(solver.at("t_max"), 1.0);
    EXPECT_EQ(solver.at("query_limit"), 3.0);
    EXPECT_EQ(solver.at("allow_processes"), false);
  }
}

TEST(FuzzReport, WritesAFindingAsJson) {
  FuzzReport report = sample();
  const nlohmann::json finding = to_json(report).at("findings").at(0);
  EXPECT_EQ(finding.at("what"), "late_toi");
  EXPECT_EQ(finding.at("kind"), "vertex-face");
  EXPECT_EQ(finding.at("shrinking"), "complete");
  EXPECT_EQ(finding.at("collides"), true);
  EXPECT_EQ(finding.at("answer").at("toi_lower"), 0.75);
  EXPECT_TRUE(finding.at("answer").at("toi_upper").is_null());
  EXPECT_EQ(finding.at("truth"), "collision at 0.5");
  EXPECT_EQ(finding.at("coordinates").size(), 24U);
  EXPECT_EQ(finding.at("coordinates").at(14), "-0x1p+1");
  EXPECT_EQ(finding.at("certificate"), "certificate");
  const nlohmann::json& original = finding.at("original");
  EXPECT_EQ(original.at("answer").at("toi_lower"), 0.625);
  EXPECT_EQ(original.at("truth"), "collision at 0.375");
  EXPECT_EQ(original.at("detail"), "toi_lower 0.625 is late");
  EXPECT_EQ(original.at("coordinates").at(14), "-0x1.8p+1");
  EXPECT_EQ(original.at("certificate"), "original certificate");
  EXPECT_TRUE(contains(finding.at("command"), "touchstone certify"));
  report.result.findings.front().simplest.certificate.clear();
  EXPECT_TRUE(to_json(report).at("findings").at(0).at("certificate").is_null());
}

}  // namespace
}  // namespace touchstone::verify::fuzz::fuzz_report_test

#include "verify/fuzz/fuzz_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "tests/support/queries.hpp"

namespace touchstone::verify {
namespace {

FuzzReport sample() {
  FuzzReport report;
  report.method = "mine";
  report.promise = fast::Promise::exact;
  report.seed = 7;
  report.separation = {.distance = 0.5, .norm = Norm::l2};
  report.result.queries = 3000;
  report.result.images = 300;
  report.result.collisions = 1000;
  report.result.judged_by_oracle = 40;
  report.result.seconds = 2.0;
  report.result.method_seconds = 1.5;
  report.result.other_seconds = 0.5;
  report.result.all_findings = 12;
  report.result.generators = {
      {.name = "grid", .queries = 3000, .collisions = 1000, .signatures = 20, .findings = 12}};
  report.result.findings = {{.what = FindingKind::late_toi,
                             .kind = Kind::vertex_face,
                             .query = tests::over_triangle(1, 1, 1, -2).query,
                             .separation = report.separation,
                             .method = "mine",
                             .answer = {.verdict = fast::Verdict::yes, .toi_lower = 0.75},
                             .collides = true,
                             .truth = "collision at 0.5",
                             .detail = "toi_lower 0.75 is late",
                             .certificate = "certificate",
                             .seconds = 1.25,
                             .queries = 1234,
                             .generator = "grid"}};
  return report;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FuzzReport, SaysAFindingInWords) {
  const std::string text = to_text(sample().result.findings.front());
  for (const std::string part :
       {"late_toi of mine, vertex-face at minimum separation 0.5 (l2)", "grid", "1.25 s",
        "1234 queries", "toi_lower 0.75 is late", "truth: collision at 0.5"}) {
    EXPECT_TRUE(contains(text, part)) << text;
  }
}

TEST(FuzzReport, SaysTheNumbersOfARun) {
  FuzzReport report = sample();
  const std::string text = to_text(report);
  for (const std::string part :
       {"mine (exact), seed 7, minimum separation 0.5 (l2): 3000 queries in 2.0 s", "300 of them",
        "1500 queries a second, 6000 without the method's own time; 40 judged", "generator",
        "1 findings, 12 with all that are like them"}) {
    EXPECT_TRUE(contains(text, part)) << text;
  }
  report.result.findings.clear();
  report.result.all_findings = 0;
  EXPECT_TRUE(contains(to_text(report), "no findings"));
}

TEST(FuzzReport, WritesAllAsJson) {
  const nlohmann::json json = to_json(sample());
  EXPECT_EQ(json.at("method"), "mine");
  EXPECT_EQ(json.at("promise"), "exact");
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_EQ(json.at("separation").at("norm"), "l2");
  EXPECT_EQ(json.at("queries_per_second"), 1500.0);
  EXPECT_EQ(json.at("judged_per_second"), 6000.0);
  EXPECT_EQ(json.at("all_findings"), 12);
  EXPECT_EQ(json.at("interrupted"), false);
  EXPECT_EQ(json.at("generators").at(0).at("signatures"), 20);
  const nlohmann::json& finding = json.at("findings").at(0);
  EXPECT_EQ(finding.at("what"), "late_toi");
  EXPECT_EQ(finding.at("kind"), "vertex-face");
  EXPECT_EQ(finding.at("collides"), true);
  EXPECT_EQ(finding.at("answer").at("toi_lower"), 0.75);
  EXPECT_TRUE(finding.at("answer").at("toi_upper").is_null());
  EXPECT_EQ(finding.at("coordinates").size(), 24U);
  EXPECT_EQ(finding.at("coordinates").at(14), "-0x1p+1");
  EXPECT_EQ(finding.at("certificate"), "certificate");
}

TEST(FindingKind, HasANameEach) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < finding_kinds; ++i) {
    names.insert(to_string(static_cast<FindingKind>(i)));
  }
  EXPECT_EQ(names.size(), finding_kinds);
}

}  // namespace
}  // namespace touchstone::verify

#include "verify/report/judgement_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tests/support/judgements.hpp"

namespace touchstone::verify::report::judgement_report_test {
namespace {

using fast::Verdict;

constexpr judge::GroundTruth miss{.index = 3, .collides = false, .toi = std::nullopt};
const judge::GroundTruth hit{.index = 4, .collides = true, .toi = exact::DoubleInterval{0.5, 0.5}};

/// 22 false negatives, a false positive, an undecided answer, a late time of impact and an early
/// one, and an error.
judge::Judgement wrong_in_each_way() {
  judge::Judgement judgement;
  for (int i = 0; i < 22; ++i) tests::add(judgement, hit, {.verdict = Verdict::no});
  tests::add(judgement, miss, {.verdict = Verdict::yes});
  tests::add(judgement, hit, {.verdict = Verdict::undecided});
  tests::add(judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.75});
  tests::add(judgement, hit, {.verdict = Verdict::yes, .toi_lower = 0.25, .toi_upper = 0.375});
  tests::add(judgement, hit, {.verdict = Verdict::error});
  return judgement;
}

TEST(JudgementReport, HasACellForEachColumn) {
  const judge::Judgement judgement = wrong_in_each_way();
  EXPECT_EQ(fault_cells(judgement), (io::TextRow{"22", "1", "1", "1", "1", "1"}));
  EXPECT_EQ(fault_columns().size(), fault_cells(judgement).size());
  EXPECT_EQ(toi_error_cells(judgement.toi_errors).size(), toi_error_columns().size());
  EXPECT_EQ(toi_error_cells(judgement.toi_errors).back(), "2.50e-01");
  EXPECT_EQ(toi_error_cells(judge::ToiErrors()), (io::TextRow{"-", "-", "-"}));
}

std::string lines(fast::Promise promise) {
  const judge::Judgement judgement = wrong_in_each_way();
  return wrong_answers_text({.method = "a\nb",
                             .promise = promise,
                             .judgement = judgement,
                             .group = "group",
                             .kind = "edge-edge"},
                            [](std::size_t i) {
                              return data::QueryPlace{"\x1b.csv", 100 + i};
                            });
}

TEST(JudgementReport, NamesTwentyAnswersOfAFaultAndCountsTheOthers) {
  const std::string text = lines(fast::Promise::conservative);
  const std::string place = "a\\x0ab: \\x1b.csv: edge-edge query ";
  EXPECT_TRUE(
      text.starts_with("false negative: " + place + "100: answer no, truth collision at 0.5\n"))
      << text;
  EXPECT_NE(text.find(place + "119: "), std::string::npos);
  EXPECT_EQ(text.find(place + "120: "), std::string::npos);
  EXPECT_NE(text.find("late toi: " + place + "123: answer toi_lower 0.75, truth"),
            std::string::npos);
  EXPECT_TRUE(text.ends_with("\nfalse negative: a\\x0ab: group: and 2 more\n")) << text;
}

TEST(JudgementReport, NamesAnswersThatBreakThePromiseOnly) {
  EXPECT_EQ(lines(fast::Promise::conservative).find("false positive: "), std::string::npos);
  EXPECT_NE(lines(fast::Promise::exact).find("false positive: "), std::string::npos);
}

TEST(JudgementReport, CountsFailuresByKind) {
  FailureCounts failures{};
  EXPECT_EQ(to_text(failures), "");
  failures[static_cast<std::size_t>(judge::Fault::crash)] = 1;
  failures[static_cast<std::size_t>(judge::Fault::hang)] = 23;
  EXPECT_EQ(to_text(failures), "1 crash, 23 hang");
  EXPECT_EQ(to_json(failures).size(), judge::all_failures.size());
  EXPECT_EQ(to_json(failures).at("hang"), 23);
  EXPECT_EQ(to_json(failures).at("exit"), 0);
}

TEST(JudgementReport, SaysWhatWasNotReadAsItStands) {
  EXPECT_EQ(reading_text(0, 0), "");
  EXPECT_EQ(reading_text(4, 9), "4 queries in error skipped\n9 coordinates rounded to double\n");
}

TEST(JudgementReport, IsJson) {
  nlohmann::json json = to_json(wrong_in_each_way());
  json.at("toi_error").erase("histogram");
  EXPECT_EQ(
      json,
      (nlohmann::json{
          {"false_negatives", 22},
          {"false_positives", 1},
          {"late_toi", 1},
          {"early_toi_upper", 1},
          {"beyond_tolerance", 0},
          {"undecided", 1},
          {"errors", 1},
          {"outside", 0},
          {"left_out", 0},
          {"late",
           {{"count", 1}, {"beyond", {1, 1, 1, 1}}, {"greatest", 0.25}, {"greatest_ulps", 0x1p51}}},
          {"toi_error",
           {{"count", 2}, {"p50", 0.25}, {"p90", 0.25}, {"p99", 0.25}, {"max", 0.25}}}}));
  EXPECT_TRUE(to_json(judge::Judgement()).at("toi_error").is_null());
  EXPECT_EQ(to_json(wrong_in_each_way().wrong_answers.front()),
            (nlohmann::json{{"index", 4},
                            {"fault", "false negative"},
                            {"answer", "no"},
                            {"truth", "collision at 0.5"}}));
}

TEST(SpreadOf, IsNothingWithoutErrors) {
  judge::ToiErrors errors;
  EXPECT_FALSE(spread_of(errors).has_value());
  errors.add(0.0);
  errors.add(0.5);
  errors.add(0.0);
  EXPECT_EQ(spread_of(errors), (Spread{.count = 3, .median = 0.0, .max = 0.5}));
}

}  // namespace
}  // namespace touchstone::verify::report::judgement_report_test

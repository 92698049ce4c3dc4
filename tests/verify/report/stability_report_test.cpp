#include "verify/report/stability_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/methods.hpp"

namespace touchstone::verify::report::stability_report_test {
namespace {

using fast::Verdict;

/// One cell of ten judged queries, half of which collide.
stability::StabilityCell cell(const std::string& hardness, int level,
                              const judge::Judgement& judgement) {
  stability::StabilityCell result{.hardness = &stability::hardness_from_name(hardness),
                                  .level = level,
                                  .kind = Kind::edge_edge,
                                  .judged = {}};
  result.judged.queries = 10;
  result.judged.collisions = 5;
  result.judged.methods.push_back({.name = "planted",
                                   .promise = fast::Promise::conservative,
                                   .timed = true,
                                   .judgement = judgement});
  return result;
}

judge::Judgement faults(std::uint64_t false_negatives, std::uint64_t false_positives) {
  judge::Judgement result;
  result.queries = 10;
  result.collisions = 5;
  result.nanoseconds = 1234.0;
  result.checks = 25;
  result.faults[static_cast<std::size_t>(judge::Fault::false_negative)] = false_negatives;
  result.faults[static_cast<std::size_t>(judge::Fault::false_positive)] = false_positives;
  return result;
}

stability::StabilityResult result_of(const std::vector<stability::StabilityCell>& cells) {
  stability::StabilityResult result;
  result.seed = 3;
  result.count = 10;
  result.cells = cells;
  for (const stability::StabilityCell& one : cells) result.total += one.judged;
  return result;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(StabilityText, HasALineAHardnessAndACharacterALevel) {
  judge::Judgement late = faults(0, 0);
  late.faults[static_cast<std::size_t>(judge::Fault::late_toi)] = 1;
  judge::Judgement wrong = faults(0, 0);
  wrong.faults[static_cast<std::size_t>(judge::Fault::crash)] = 1;
  judge::Judgement far = faults(0, 1);
  far.faults[static_cast<std::size_t>(judge::Fault::beyond_tolerance)] = 1;
  const std::string text = to_text(result_of(
      {cell("distance", -1, faults(0, 0)), cell("distance", -5, faults(0, 2)),
       cell("distance", -10, faults(0, 5)), cell("distance", -15, faults(1, 5)),
       cell("distance", -20, late), cell("distance", -25, wrong), cell("distance", -30, far)}));
  EXPECT_TRUE(contains(text, "planted (conservative): breaks its promise\n")) << text;
  EXPECT_TRUE(contains(text, "  edge-edge    .49NTEB         .....E.           70 ")) << text;
  EXPECT_TRUE(contains(text, "     123.4        2.5          -          -\n")) << text;
}

TEST(StabilityText, TellsAnUlpFromATimeThatIsMuchTooLate) {
  judge::Judgement slight = faults(0, 3);
  slight.faults[static_cast<std::size_t>(judge::Fault::late_toi)] = 2;
  slight.slightly_late = 2;
  judge::Judgement much = slight;
  much.slightly_late = 1;
  judge::Judgement unasked;
  unasked.left_out = 4;
  const std::string text = to_text(result_of(
      {cell("distance", -1, slight), cell("distance", -5, much), cell("distance", -10, unasked)}));
  EXPECT_TRUE(contains(text, "  edge-edge    tT-             ...")) << text;
  EXPECT_TRUE(contains(text, "not asked: 4 queries left out")) << text;
}

/// Errors and hangs come after worse faults.
TEST(StabilityText, ShowsErrorsAndHangsBesideTheWorst) {
  judge::Judgement both = faults(1, 0);
  both.faults[static_cast<std::size_t>(judge::Fault::crash)] = 1;
  both.faults[static_cast<std::size_t>(judge::Fault::hang)] = 1;
  judge::Judgement hung = faults(0, 0);
  hung.faults[static_cast<std::size_t>(judge::Fault::hang)] = 1;
  const std::string text = to_text(result_of({cell("digits", 1, both), cell("digits", 2, hung)}));
  EXPECT_TRUE(contains(text, "digits    1 digits … 15 digits  edge-edge    N.              #H "))
      << text;
  EXPECT_TRUE(contains(text, ". every answer is right")) << text;
}

TEST(StabilityText, KeepsItsPromiseWithFalsePositivesOnly) {
  EXPECT_TRUE(contains(to_text(result_of({cell("scale", 0, faults(0, 5))})),
                       "planted (conservative): keeps its promise\n"));
}

TEST(StabilityText, HoldsNoSolverToAPromiseThatItDoesNotMake) {
  stability::StabilityResult result = result_of({cell("scale", 0, faults(1, 0))});
  result.total.methods[0].promise = fast::Promise::none;
  EXPECT_TRUE(
      contains(to_text(result), "planted: promises nothing; answers worse than false positives\n"));
  result = result_of({cell("scale", 0, faults(0, 5))});
  result.total.methods[0].promise = fast::Promise::none;
  EXPECT_TRUE(
      contains(to_text(result), "planted: promises nothing; nothing worse than false positives\n"));
}

TEST(StabilityText, NamesSeparationAndDisagreements) {
  stability::StabilityResult result = result_of({cell("angle", -1, faults(0, 0))});
  EXPECT_FALSE(contains(to_text(result), "minimum separation"));
  result.separation = {.distance = 0.5, .norm = Norm::l2};
  result.cells[0].judged.name = "angle 2^-1";
  result.cells[0].judged.mismatches.push_back({.of = judge::Mismatch::Of::label,
                                               .index = 4,
                                               .recorded = "collision",
                                               .truth = "no collision"});
  const std::string text = to_text(result);
  EXPECT_TRUE(contains(text, "minimum separation 0.5 (l2)\n"));
  EXPECT_TRUE(contains(text,
                       "disagreement: angle 2^-1: edge-edge query 4: certified solver "
                       "collision, oracle no collision\n"))
      << text;
}

TEST(StabilityJson, HasEveryCellOfEveryMethod) {
  judge::Judgement with_error = faults(1, 3);
  with_error.toi_errors.add(0.25);
  const nlohmann::json json =
      to_json(result_of({cell("scale", -800, faults(0, 0)), cell("scale", 0, with_error)}));
  EXPECT_EQ(json.at("seed"), 3);
  EXPECT_EQ(json.at("count"), 10);
  EXPECT_TRUE(json.at("separation").is_null());
  EXPECT_EQ(json.at("interrupted"), false);
  EXPECT_EQ(json.at("disagreements"), 0);
  ASSERT_EQ(json.at("hardnesses").size(), 1U);
  EXPECT_EQ(json.at("hardnesses")[0].at("name"), "scale");
  EXPECT_EQ(json.at("hardnesses")[0].at("levels").size(), 11U);
  ASSERT_EQ(json.at("methods").size(), 1U);
  const nlohmann::json& method = json.at("methods")[0];
  EXPECT_EQ(method.at("name"), "planted");
  EXPECT_EQ(method.at("promise"), "conservative");
  EXPECT_EQ(method.at("keeps_promise"), false);
  ASSERT_EQ(method.at("cells").size(), 2U);
  const nlohmann::json& calm = method.at("cells")[0];
  EXPECT_TRUE(calm.at("worst").is_null());
  EXPECT_TRUE(calm.at("toi_error").is_null());
  EXPECT_EQ(calm.at("level"), std::ldexp(1.0, -800));
  const nlohmann::json& hard = method.at("cells")[1];
  EXPECT_EQ(hard.at("hardness"), "scale");
  EXPECT_EQ(hard.at("level"), 1.0);
  EXPECT_EQ(hard.at("kind"), "edge-edge");
  EXPECT_EQ(hard.at("queries"), 10);
  EXPECT_EQ(hard.at("collisions"), 5);
  EXPECT_EQ(hard.at("false_negatives"), 1);
  EXPECT_EQ(hard.at("false_negative_rate"), 0.2);
  EXPECT_EQ(hard.at("false_positive_rate"), 0.6);
  EXPECT_EQ(hard.at("worst"), "false negative");
  EXPECT_EQ(hard.at("worst_rate"), 0.2);
  EXPECT_EQ(hard.at("toi_error").at("max"), 0.25);
  EXPECT_EQ(hard.at("ns_per_query"), 123.4);
  EXPECT_EQ(hard.at("checks_per_query"), 2.5);
}

TEST(StabilityJson, IsNullWhereNothingIsKnown) {
  stability::StabilityCell unknown = cell("scale", 0, judge::Judgement{});
  unknown.judged.methods[0].timed = false;
  stability::StabilityResult result = result_of({unknown});
  result.separation = {.distance = 0.5, .norm = Norm::l2};
  const nlohmann::json json = to_json(result);
  const nlohmann::json& only = json.at("methods")[0].at("cells")[0];
  EXPECT_TRUE(only.at("ns_per_query").is_null());
  EXPECT_TRUE(only.at("checks_per_query").is_null());
  EXPECT_EQ(json.at("separation").at("norm"), "l2");
}

TEST(StabilityMarks, HoldWhatAReportShowsOfACell) {
  judge::Judgement wrong = faults(1, 3);
  wrong.toi_errors.add(0.25);
  wrong.faults[static_cast<std::size_t>(judge::Fault::undecided)] = 2;
  const auto marks =
      marks_of(result_of({cell("scale", -800, judge::Judgement{}), cell("scale", 0, wrong)}));
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_FALSE(marks[0].worst);
  EXPECT_TRUE(std::isnan(marks[0].checks));
  EXPECT_FALSE(marks[0].toi_error.has_value());
  EXPECT_EQ(marks[1].method, "planted");
  EXPECT_EQ(marks[1].hardness, "scale");
  EXPECT_EQ(marks[1].exponent, 0);
  EXPECT_EQ(marks[1].false_negatives, 1U);
  EXPECT_EQ(marks[1].undecided, 2U);
  EXPECT_EQ(marks[1].worst, judge::Fault::false_negative);
  EXPECT_EQ(marks[1].worst_rate, 0.2);
  EXPECT_EQ(marks[1].toi_error->max, 0.25);
  EXPECT_EQ(marks[1].nanoseconds, 123.4);
  EXPECT_EQ(marks[1].checks, 2.5);
}

TEST(StabilityOverview, HasTheWorstOfEachHardness) {
  const Table table =
      overview_of(result_of({cell("distance", -1, faults(0, 1)), cell("distance", -5, faults(1, 0)),
                             cell("scale", 0, faults(0, 0)), cell("angle", 0, faults(0, 2))}));
  using Row = std::vector<std::string>;
  EXPECT_EQ(table.columns, (Row{"method", "distance", "scale", "angle"}));
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0],
            (Row{"planted", "false negative 10 %", "nothing wrong", "false positive 40 %"}));
  EXPECT_EQ(overview_of(stability::StabilityResult{}).columns, Row{"method"});
}

}  // namespace
}  // namespace touchstone::verify::report::stability_report_test

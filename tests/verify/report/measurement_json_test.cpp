#include "verify/report/measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/support/measurements.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/report/bench_report.hpp"
#include "verify/report/certify_report.hpp"
#include "verify/report/report_page.hpp"
#include "verify/view/view_page.hpp"

namespace touchstone::verify::report::measurement_json_test {
namespace {

using judge::Fault;
/// With an example of everything.
Measurements example() {
  Measurements measurements = tests::small_report();
  measurements.groups = {
      {.name = "handcrafted", .kind = Kind::edge_edge, .queries = 200, .digest = 1}};
  measurements.all[0].scale = 1e-3;
  measurements.all[0].achieved_tolerance =
      Spread{.count = 2, .median = 1.0, .max = std::numeric_limits<double>::infinity()};
  StabilityMark& mark = measurements.stability[0];
  mark.late_tois = 3;
  mark.toi_error = Spread{.count = 8, .median = 0.0, .max = 1e-9};
  mark.checks = 2.5;
  return measurements;
}

/// Each number, truth value and name that is written is read: if it is changed, it stays changed.
TEST(MeasurementJson, ComesBackWithoutLoss) {
  const nlohmann::json written = to_json(example());
  const Measurements read = measurements_from_json(nlohmann::json::parse(written.dump()));
  EXPECT_EQ(read.all[0].achieved_tolerance, example().all[0].achieved_tolerance);
  EXPECT_EQ(read.stability, example().stability);
  EXPECT_EQ(to_json(read), written);
  int changes = 0;
  const nlohmann::json leaves = written.flatten();
  for (const auto& [place, value] : leaves.items()) {
    nlohmann::json changed = written;
    nlohmann::json& leaf = changed[nlohmann::json::json_pointer(place)];
    if (value.is_boolean()) leaf = !value.get<bool>();
    if (value.is_number_integer()) leaf = value.get<std::int64_t>() + 1;
    if (value.is_number_float()) leaf = value.get<double>() + 1.0;
    if (place.ends_with("/method") || place.ends_with("/machine")) leaf = "another";
    changes += changed == written ? 0 : 1;
    EXPECT_EQ(to_json(measurements_from_json(changed)), changed) << place;
  }
  EXPECT_GT(changes, 300);
}

/// From before there were scale and date, and maps had all counts.
TEST(MeasurementJson, ReadsWhatEarlierVersionsWrote) {
  nlohmann::json earlier = to_json(example());
  earlier["measurements"][0].erase("scale");
  earlier.erase("date");
  for (const char* const later :
       {"late_tois", "early_upper_tois", "beyond_tolerance", "errors", "undecided", "toi_error",
        "checks_per_query", "is_power", "is_slight", "hangs"}) {
    earlier["stability"][0].erase(later);
  }
  const Measurements read = measurements_from_json(earlier);
  EXPECT_FALSE(read.all[0].scale.has_value());
  EXPECT_EQ(read.date, "");
  const StabilityMark& mark = read.stability.at(0);
  EXPECT_EQ(mark.false_negatives, 4U);
  EXPECT_EQ(mark.late_tois, 0U);
  EXPECT_TRUE(mark.is_power);
  EXPECT_EQ(mark.hangs, 0U);
  EXPECT_FALSE(mark.toi_error.has_value());
  EXPECT_TRUE(std::isnan(mark.checks));
}

TEST(MeasurementJson, InvalidTextIsRefused) {
  const nlohmann::json good = to_json(example());
  for (const char* const patch :
       {R"([{"op": "replace", "path": "/format", "value": "touchstone measurements 0"}])",
        R"([{"op": "remove", "path": "/measurements/0/asked"}])",
        R"([{"op": "replace", "path": "/measurements/0/kind", "value": "face-face"}])",
        R"([{"op": "replace", "path": "", "value": 3}])"}) {
    EXPECT_THROW(
        static_cast<void>(measurements_from_json(good.patch(nlohmann::json::parse(patch)))),
        std::runtime_error)
        << patch;
  }
}

// ---- Baselines ----------------------------------------------------------------------------------

/// The result of a file of ten queries, in which a solver has these faults.
jobs::CertifyResult result_of(const std::string& file, const std::string& solver,
                              fast::Promise promise,
                              const std::vector<std::pair<std::uint64_t, Fault>>& faults) {
  jobs::MethodResult method;
  method.name = solver;
  method.promise = promise;
  for (const auto& [index, fault] : faults) {
    ++method.judgement.faults[static_cast<std::size_t>(fault)];
    method.judgement.wrong_answers.push_back(
        {.fault = fault, .index = index, .answer = "", .truth = ""});
  }
  jobs::CertifyResult result;
  result.name = file;
  result.shape = QueryShape{.kind = Kind::edge_edge};
  result.queries = 10;
  result.methods = {method};
  return result;
}

std::vector<jobs::CertifyResult> results_of(
    const std::vector<std::pair<std::uint64_t, Fault>>& faults) {
  return {result_of("a_ee.csv", "naive", fast::Promise::conservative, faults)};
}

TEST(Gate, ABaselineIsReadAsItIsWritten) {
  const KnownAnswers known{
      {"naïve \"1\"", "folder/a,b.csv", "vertex-face", 7, 0.1, "l2", Fault::late_toi},
      {"naive", "a_ee.csv", "edge-edge", 0, 0.0, "l2", Fault::false_negative}};
  const tests::TemporaryFolder folder;
  EXPECT_EQ(read_baseline(folder.file("known.json", baseline_document(known))), known);
  const auto other =
      folder.file("other.json", R"({"known": [["naive", "a", "edge-edge", 1, "luck"]]})");
  EXPECT_THROW(static_cast<void>(read_baseline(other)), io::DatasetError);
  // As of version 0.4: about contact.
  const auto old =
      folder.file("old.json", R"({"known": [["naive", "a_ee.csv", "edge-edge", 0, "late_toi"]]})");
  EXPECT_EQ(read_baseline(old),
            (KnownAnswers{{"naive", "a_ee.csv", "edge-edge", 0, 0.0, "l2", Fault::late_toi}}));
}

// New answers and mended ones, and the badge, are in tests/transcripts/certify.md.
TEST(Gate, AnAnswerIsMendedIfItsQueryWasAskedAtItsSeparationAndAllowedOnesAreNone) {
  EXPECT_TRUE(wrong_answers_of(results_of({{3, Fault::false_positive}})).empty());
  const KnownAnswers before{{"naive", "a_ee.csv", "edge-edge", 10, 0.0, "l2", Fault::crash},
                            {"naive", "a_ee.csv", "edge-edge", 10, 0.0, "l2", Fault::late_toi},
                            {"naive", "a_ee.csv", "edge-edge", 10, 0.5, "linf", Fault::crash},
                            {"naive", "a_ee.csv", "edge-edge", 11, 0.0, "l2", Fault::crash},
                            {"other", "a_ee.csv", "edge-edge", 10, 0.0, "l2", Fault::crash}};
  KnownAnswers asked;
  add_of_query(before, known_query("naive", "a_ee.csv", Kind::edge_edge, 10, {.norm = Norm::linf}),
               asked);
  const auto change = change_of(before, asked, results_of({{10, Fault::late_toi}}));
  EXPECT_EQ(change.mended,
            (KnownAnswers{{"naive", "a_ee.csv", "edge-edge", 10, 0.0, "l2", Fault::crash}}));
  EXPECT_EQ(change.now.size(), before.size() - 1);
  EXPECT_TRUE(change.fresh.empty());
}

TEST(Gate, MoreAnswersThanAreKeptAreAnError) {
  auto results = results_of({{1, Fault::false_negative}});
  results[0].methods[0].judgement.faults[0] = judge::Judgement::most_kept + 1;
  EXPECT_THROW(static_cast<void>(wrong_answers_of(results)), std::runtime_error);
}

// The rest of it is in tests/transcripts/bench.md.
TEST(BenchReport, AnImpactThatContradictsTheCollisionsIsWrong) {
  BenchReport report;
  report.step.emplace().earliest.emplace();
  EXPECT_FALSE(has_wrong_answers(report));
  report.step->earliest_agrees = false;
  EXPECT_TRUE(has_wrong_answers(report));
  EXPECT_NE(to_text(report).find("NOT that of the collisions"), std::string::npos);
}

// ---- The page -----------------------------------------------------------------------------------

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Page, LoadsNothingAndHoldsNoMarkupOfNames) {
  Measurements measurements = tests::small_report();
  measurements.command = "</pre><b>\x1b";
  for (Measurement& measurement : measurements.all) measurement.group = "g</script>\u202e\n";
  std::string page = report_page(measurements);
  page.erase(page.find(d3_script()), d3_script().size());  // its comments have addresses
  EXPECT_TRUE(contains(page, R"("command":"\u003c/pre>\u003cb>\\x1b")"));
  EXPECT_TRUE(contains(page, R"("group":"g\u003c/script>\\xe2\\x80\\xae\\x0a")"));
  EXPECT_FALSE(contains(page, "g</script>"));
  EXPECT_FALSE(contains(page, "\u202e"));
  EXPECT_FALSE(
      std::regex_search(page, std::regex("https?:|<(link|img|iframe|object)|@import|src=|url\\(")));
}

TEST(Page, HasTextsThatEndNoElementAndTheNoticeOfD3) {
  EXPECT_TRUE(d3_script().starts_with("// https://d3js.org v")) << d3_script().substr(0, 80);
  EXPECT_NE(d3_script().find("Copyright"), std::string_view::npos);
  for (const std::string_view text : {d3_script(), report_script(), page_script(), page_style(),
                                      view::view_script(), view::view_style()}) {
    for (const std::string_view end : {"</script", "</style", "<!--"}) {
      EXPECT_EQ(text.find(end), std::string_view::npos) << end;
    }
  }
}

TEST(StabilityPage, HoldsNoMarkupOfNames) {
  const std::string page =
      stability_page(tests::map_of({0.0, 0.0}, "</script>&\"\xE9"), "</pre>\x1b");
  EXPECT_TRUE(contains(page, R"("\u003c/script>&\"\\xe9 (conservative): breaks its promise.")"));
  EXPECT_TRUE(contains(page, R"("command":"\u003c/pre>\\x1b")"));
  EXPECT_TRUE(contains(page, R"(["\u003c/script>&\"\\xe9","false negative 50 %"])"));
  EXPECT_FALSE(contains(page, "</script>&"));
}

TEST(ViewPage, HoldsItsQueriesAndTheScriptAndNoMarkupOfNames) {
  const std::string page = view::view_page({{{"label", "</script>"}}}, "touchstone view a<b");
  EXPECT_TRUE(contains(page, R"(id="queries">[{"label":"\u003c/script>"}]</script>)"));
  EXPECT_TRUE(contains(page, std::string(view::view_script())));
  EXPECT_TRUE(contains(page, "touchstone view a&lt;b"));
}

}  // namespace
}  // namespace touchstone::verify::report::measurement_json_test

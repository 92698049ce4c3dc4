#include "verify/report/page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/measurements.hpp"
#include "verify/report/figures.hpp"
#include "verify/report/page_texts.hpp"

namespace touchstone::verify::report::page_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The text between two others; empty if they are missing.
std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t start = text.find(before);
  if (start == std::string::npos) return {};
  const std::size_t first = start + before.size();
  return text.substr(first, text.find(after, first) - first);
}

/// The page without the library, in which comments and namespaces contain addresses.
std::string without_d3(std::string page) {
  const std::size_t start = page.find(d3_script());
  return page.erase(start, d3_script().size());
}

TEST(Page, HoldsTheFiguresAsTheScriptReadsThem) {
  const Measurements measurements = tests::small_report();
  const std::string page = report_page(measurements);
  const std::string json =
      between(page, R"(<script type="application/json" id="figures">)", "</script>");
  EXPECT_EQ(nlohmann::json::parse(json), to_json(figures_of(measurements)));
  for (const Figure& figure : figures_of(measurements)) {
    EXPECT_TRUE(contains(page, "<section class=\"figure\" id=\"" + figure.id + "\">"));
    EXPECT_TRUE(contains(page, "download=\"" + figure.id + ".csv\""));
  }
}

TEST(Page, HoldsNoMarkupOfNames) {
  Measurements measurements = tests::small_report();
  measurements.command = "</pre><b>\x1b";
  for (Measurement& measurement : measurements.all) measurement.group = "g</script>\u202e\n";
  const std::string page = report_page(measurements);
  EXPECT_TRUE(contains(page, "&lt;/pre&gt;&lt;b&gt;\\x1b"));
  EXPECT_TRUE(contains(page, "g&lt;/script&gt;\\xe2\\x80\\xae\\x0a, vertex-face"));
  EXPECT_FALSE(contains(page, "g</script>"));
  EXPECT_FALSE(contains(page, "\u202e"));
}

TEST(Page, MayLoadNothingFromAnywhere) {
  const std::string page = report_page(tests::small_report());
  EXPECT_TRUE(contains(page,
                       "content=\"default-src 'none'; script-src 'unsafe-inline'; style-src "
                       "'unsafe-inline'; img-src data:\""));
  const std::string ours = without_d3(page);
  EXPECT_LT(ours.size(), page.size());
  EXPECT_FALSE(std::regex_search(ours, std::regex("https?:")));
  EXPECT_FALSE(
      std::regex_search(ours, std::regex("<(link|img|iframe|object)|@import|src=|url\\(")));
}

TEST(Page, SaysWhatMadeItAndEscapesIt) {
  const std::string page = report_page(tests::small_report());
  EXPECT_TRUE(contains(page, "Made on a machine, 2026-01-31 by"));
  EXPECT_FALSE(contains(page, "<page>"));
  EXPECT_TRUE(contains(page, "a &lt;page&gt;.html"));
}

stability::StabilityResult map_of_one_cell(const std::string& method) {
  stability::StabilityResult result;
  result.seed = 77;
  result.count = 10;
  stability::StabilityCell cell{.hardness = &stability::hardness_from_name("distance"),
                                .level = -50,
                                .kind = Kind::edge_edge,
                                .judged = {}};
  cell.judged.queries = 10;
  cell.judged.collisions = 5;
  jobs::MethodResult judged{
      .name = method, .promise = fast::Promise::conservative, .timed = true, .judgement = {}};
  judged.judgement.queries = 10;
  judged.judgement.collisions = 5;
  judged.judgement.nanoseconds = 1000.0;
  judged.judgement.faults[static_cast<std::size_t>(judge::Fault::false_negative)] = 1;
  cell.judged.methods.push_back(judged);
  result.total += cell.judged;
  result.cells.push_back(cell);
  return result;
}

TEST(StabilityPage, HoldsNoMarkupOfNames) {
  const std::string page =
      without_d3(stability_page(map_of_one_cell("</script>&\"\xE9"), "</pre>\x1b"));
  EXPECT_TRUE(contains(page, "&lt;/script&gt;&amp;&quot;\\xe9 (conservative)"));
  EXPECT_TRUE(contains(page, "&lt;/pre&gt;\\x1b"));
  EXPECT_FALSE(contains(page, "</script>&"));
}

}  // namespace
}  // namespace touchstone::verify::report::page_test

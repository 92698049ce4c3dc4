/// \file
/// The page of a report in a real browser: headless Chromium loads it from a file, runs its script
/// and returns the resulting document.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/browser_test.hpp"
#include "tests/support/measurements.hpp"
#include "verify/report/report_page.hpp"

namespace touchstone::verify::report::report_browser_test {
namespace {

class Browser : public tests::BrowserTest {};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++result;
  }
  return result;
}

/// The widths that a section's pictures are drawn for.
std::set<double> widths(const std::string& drawn) {
  const std::regex width("viewBox=\"0 0 ([0-9.]+) ");
  std::set<double> result;
  for (std::sregex_iterator at(drawn.begin(), drawn.end(), width), end; at != end; ++at) {
    result.insert(std::stod((*at)[1]));
  }
  return result;
}

/// The section of a figure in a document.
std::string section(const std::string& dom, const std::string& id) {
  const std::size_t start = dom.find(R"(<section class="figure" id=")" + id + "\">");
  if (start == std::string::npos) return {};
  return dom.substr(start, dom.find("</section>", start) - start);
}

/// The figures of the small report, and their panels.
const std::vector<std::pair<std::string, std::size_t>> figures{
    {"speed_false_positives", 1}, {"speed_toi_median", 1}, {"speed_toi_max", 1},
    {"running_times", 1},         {"tolerance_time", 1},   {"tolerance_false_positives", 1},
    {"separation_time", 1},       {"checks_early", 1},     {"checks_tolerance", 1},
    {"filter_misses", 1},         {"stages", 1},           {"stability", 1},
    {"stability_time", 1}};

/// Clicks on the names of columns, and writes the orders of the rows.
constexpr const char* sorting = R"(<p id="orders"></p><script>
const table = document.querySelector("#table_1 table");
const button = (name) => Array.from(table.querySelectorAll("thead button")).find((b) => b.textContent === name);
const order = () => Array.from(table.tBodies[0].rows, (row) => row.cells[0].textContent).join(" ");
const orders = [];
for (const name of ["FN", "FN", "÷ certified", "published FN", "published FN"]) {
  button(name).click();
  orders.push(`${name} ${button(name).parentNode.ariaSort}: ${order()}`);
}
document.getElementById("orders").textContent = orders.join("; ");
</script>)";

/// Also on a telephone. A click on a column's name sorts by it, numbers by value and other texts
/// last.
TEST_F(Browser, DrawsEveryFigureAndSortsATable) {
  Measurements measurements = tests::small_report();
  for (Measurement& m : measurements.all) {
    if (m.achieved_tolerance) m.achieved_tolerance->max = std::numeric_limits<double>::infinity();
  }
  std::string page = report_page(measurements);
  page.insert(page.rfind("</body>"), sorting);
  for (const int width : {1200, 500}) {
    const std::string dom = load(page, width);
    EXPECT_EQ(complaints(), "");
    EXPECT_EQ(count(dom, "<section class=\"figure\""), figures.size());
    for (const auto& [id, panels] : figures) {
      const std::string drawn = section(dom, id);
      EXPECT_EQ(count(drawn, "role=\"img\""), panels) << id;
      EXPECT_EQ(count(drawn, "<desc id="), panels) << id;
      EXPECT_GE(count(drawn, "<title id="), panels) << id;
      EXPECT_GE(count(drawn, "<rect") + count(drawn, "<path"), 1U) << id;
      EXPECT_EQ(count(drawn, "class=\"csv\""), 1U) << id;
      EXPECT_EQ(count(drawn, "NaN") + count(drawn, "undefined"), 0U) << id;
    }
    EXPECT_EQ(count(section(dom, "checks_tolerance"), ">∞</text>"), 1U);
    const std::set<double> speed = widths(section(dom, "speed_false_positives"));
    ASSERT_FALSE(speed.empty());
    EXPECT_LE(*speed.rbegin(), width) << "drawn for the width there is, not shrunk";
    EXPECT_GE(*speed.begin(), 280.0);
    EXPECT_EQ(count(dom,
                    "FN ascending: certified tight_inclusion msrf; "
                    "FN descending: msrf certified tight_inclusion; "
                    "÷ certified ascending: certified msrf tight_inclusion; "
                    "published FN ascending: tight_inclusion msrf certified; "
                    "published FN descending: msrf tight_inclusion certified"),
              1U)
        << dom.substr(dom.find("<p id=\"orders\""), 600);
  }
}

// ---- What it says -------------------------------------------------------------------------------

/// The elements of that kind in a part of a document, each with its cells between bars.
std::vector<std::string> texts(const std::string& part, const std::string& kind) {
  const std::regex element("<" + kind + "(?: [^>]*)?>(.*?)</" + kind + ">");
  std::vector<std::string> result;
  for (std::sregex_iterator at(part.begin(), part.end(), element), end; at != end; ++at) {
    const std::string cells =
        std::regex_replace((*at)[1].str(), std::regex("</t[dh]><t[dh][^>]*>"), " | ");
    result.push_back(std::regex_replace(cells, std::regex("<[^>]*>"), ""));
  }
  return result;
}

using Texts = std::vector<std::string>;

TEST_F(Browser, OpensWithItsFindings) {
  Measurements measurements = tests::small_report();
  for (Measurement& m : measurements.all) m.keeps_promise = m.false_negatives == 0;
  measurements.all[1].outside = 7;
  const std::string dom = load(report_page(measurements));
  EXPECT_EQ(
      texts(dom.substr(dom.find("<header>"), dom.find("</header>")), "li"),
      (Texts{"Broke its promise: msrf (2 missed collisions), tight_inclusion_released (4 missed "
             "collisions).",
             "3 methods were asked up to 100 queries, 20 of which collide.",
             "No missed collision and no time of impact after the exact one: certified, "
             "tight_inclusion. Some: msrf (2 of 100).",
             "Right on every query, with no false positive either: certified.",
             "certified takes 10 ns a query. As a multiple of that, the others that miss "
             "nothing: tight_inclusion 250.",
             "On the Pareto front of time against error, among those that miss nothing: "
             "certified in 3 of 3 panels.",
             "Not asked: tight_inclusion (7 queries outside its promise, 0 for lack of "
             "time)."}));
  EXPECT_NE(dom.find("<p>Made on a machine, 2026-01-31 by</p>"), std::string::npos);
  EXPECT_NE(dom.find("touchstone report handcrafted --out 'a &lt;page&gt;.html'</pre>"),
            std::string::npos);
  const std::string table = dom.substr(dom.find("<section id=\"table_1\""));
  EXPECT_EQ(
      texts(table, "tr").at(3),
      "msrf | ✗ 2 | 1 (1.3 %) | 0.4 | 40 | 0 | 100 of 200 | 20 | 0 | – | – | 12.90 | 16 | ✗ 386");
}

/// Writes what a table is as CSV and as Markdown.
constexpr const char* written = R"(<p id="written"></p><script>
const hostile = { columns: ["a", "b|c"], rows: [["=1+1", 'x, "y"'], ["| **y** <b>", "_a_ tight_inclusion"],
  ["http://a", "-1e-300"], ["-x", NaN]] };
document.getElementById("written").textContent = encodeURI(report.csvOf(hostile)) +
  encodeURI(report.markdownOf({ ...hostile, rows: hostile.rows.slice(0, 3) }));
</script>)";

TEST_F(Browser, NoTextOfATableIsAFormulaOrMarkup) {
  std::string page = report_page(tests::small_report());
  page.insert(page.rfind("</body>"), written);
  const std::string dom = load(page);
  EXPECT_EQ(complaints(), "");
  EXPECT_EQ(texts(dom.substr(dom.find("<p id=\"written\"")), "p").at(0),
            "a,b%7Cc%0D%0A"
            "'=1+1,%22x,%20%22%22y%22%22%22%0D%0A"
            "%7C%20**y**%20%3Cb%3E,_a_%20tight_inclusion%0D%0A"
            "http://a,-1e-300%0D%0A"
            "'-x,%0D%0A"
            "%7C%20a%20%7C%20b%5C%7Cc%20%7C%0A%7C%20---%20%7C%20---%20%7C%0A"
            "%7C%20=1+1%20%7C%20x,%20%22y%22%20%7C%0A"
            "%7C%20%5C%7C%20%5C*%5C*y%5C*%5C*%20%5C%3Cb%5C%3E%20%7C%20%5C_a%5C_%20tight_inclusion%"
            "20%7C%0A"
            "%7C%20http%5C://a%20%7C%20-1e-300%20%7C%0A");
}

// ---- The map of stability -----------------------------------------------------------------------

constexpr double infinity = std::numeric_limits<double>::infinity();
const std::vector<double> numbers_of_any_size{
    0.0,     4.9e-324, 2.3e-308, 3e-100, 3.2e-13, 0.0123, 0.999,   1.5,   99.9,    999.6,   8.88e5,
    9.996e5, 1e6,      1.2e8,    8.88e8, 9.996e8, 2.5e12, 8.88e99, 1e100, 1.7e308, infinity};

/// Counts the texts in cells, and lists those wider than their cells.
constexpr const char* measuring = R"(<p id="wide"></p><script>
const texts = Array.from(document.querySelectorAll("text.cell"));
const isWide = (text) =>
  text.getBBox().width > Number(text.previousElementSibling.getAttribute("width")) + 1;
document.getElementById("wide").textContent =
  `of ${texts.length} too wide: ${texts.filter(isWide).map((text) => text.textContent).join(" ")}.`;
</script>)";

TEST_F(Browser, NumbersOfAnySizeFitIntoTheirCells) {
  std::string page = stability_page(tests::map_of(numbers_of_any_size), "touchstone stability");
  page.insert(page.rfind("</body>"), measuring);
  for (const int width : {1200, 500}) {
    const std::string dom = load(page, width);
    EXPECT_EQ(complaints(), "");
    EXPECT_TRUE(
        std::regex_search(dom, std::regex("<p id=\"wide\">of [1-9][0-9]* too wide: \\.</p>")))
        << dom.substr(dom.find("<p id=\"wide\""), 600);
  }
}

/// The test finds a page that loads something, or fails.
TEST_F(Browser, APlantedFaultIsSeen) {
  const auto planted = [](const std::string& fault) {
    std::string page = report_page(tests::small_report());
    return page.insert(page.find("</main>"), fault);
  };
  static_cast<void>(load(planted("<script>missing_function();</script>")));
  EXPECT_NE(complaints().find("missing_function"), std::string::npos) << read("err");
  static_cast<void>(load(planted("<img src=\"https://example.org/picture.png\">")));
  EXPECT_NE(complaints().find("Content Security Policy"), std::string::npos) << read("err");
}

}  // namespace
}  // namespace touchstone::verify::report::report_browser_test

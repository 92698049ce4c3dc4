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
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/browser_test.hpp"
#include "tests/support/measurements.hpp"
#include "verify/report/figures.hpp"
#include "verify/report/page.hpp"

namespace touchstone::verify::report::page_browser_test {
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
  const Measurements measurements = tests::small_report();
  const std::vector<Figure> figures = figures_of(measurements);
  ASSERT_EQ(figures.size(), 13U);
  std::string page = report_page(measurements);
  page.insert(page.rfind("</body>"), sorting);
  for (const int width : {1200, 500}) {
    const std::string dom = load(page, width);
    EXPECT_EQ(complaints(), "");
    for (const Figure& figure : figures) {
      const std::string drawn = section(dom, figure.id);
      EXPECT_EQ(count(drawn, "role=\"img\""), figure.panels.size()) << figure.id;
      EXPECT_EQ(count(drawn, "<desc id="), figure.panels.size()) << figure.id;
      EXPECT_GE(count(drawn, "<title id="), figure.panels.size()) << figure.id;
      EXPECT_GE(count(drawn, "<rect") + count(drawn, "<path"), 1U) << figure.id;
      EXPECT_EQ(count(drawn, "class=\"csv\""), 1U) << figure.id;
      EXPECT_EQ(count(drawn, "NaN") + count(drawn, "undefined"), 0U) << figure.id;
    }
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

/// The tolerances that a method states as achieved.
Spread& achieved(Measurements& measurements) {
  for (Measurement& m : measurements.all) {
    if (m.achieved_tolerance) return *m.achieved_tolerance;
  }
  throw std::invalid_argument("nobody achieves a tolerance");
}

/// The heights of the marks of a drawn figure with this end of its description.
std::vector<double> heights(const std::string& drawn, const std::string& end) {
  const std::regex mark("translate\\([0-9.]+,([0-9.]+)\\)[^>]*><title>[^<]*" + end + "</title>");
  std::vector<double> result;
  for (std::sregex_iterator it(drawn.begin(), drawn.end(), mark), last; it != last; ++it) {
    result.push_back(std::stod((*it)[1]));
  }
  return result;
}

TEST_F(Browser, PanelsHaveOneScaleWithWhatIsInfiniteAtTheUpperEnd) {
  Measurements measurements = tests::small_report();
  achieved(measurements).max = std::numeric_limits<double>::infinity();
  measurements.all.push_back(tests::measured("simulation", "certified", 10.0));
  const std::string dom = load(report_page(measurements), 1400);
  EXPECT_EQ(complaints(), "");
  const std::string speed = section(dom, "speed_false_positives");
  EXPECT_EQ(count(speed, "role=\"img\""), 2U);
  EXPECT_EQ(widths(speed).size(), 1U);
  const std::string drawn = section(dom, "checks_tolerance");
  EXPECT_EQ(count(drawn, "NaN"), 0U);
  EXPECT_EQ(count(drawn, ">∞</text>"), 1U) << drawn;
  EXPECT_EQ(count(drawn, ">0</text>"), 0U) << "nothing is zero";
  const std::vector<double> infinite = heights(drawn, "∞"), median = heights(drawn, "0.25");
  ASSERT_EQ(infinite.size(), 1U) << drawn;
  ASSERT_EQ(median.size(), 1U) << drawn;
  EXPECT_LT(infinite[0], median[0]) << "heights are counted from the top";
}

// ---- The map of stability -----------------------------------------------------------------------

/// A level for each number, as the error of the time of impact, as time in nanoseconds, and as
/// checks; every other one has a false negative.
stability::StabilityResult map_of(const std::vector<double>& numbers) {
  stability::StabilityResult result;
  result.count = 1;
  const stability::Hardness& hardness = stability::hardness_from_name("distance");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    stability::StabilityCell cell{
        .hardness = &hardness,
        .level = hardness.levels.at(i % hardness.levels.size()),
        .kind = i < hardness.levels.size() ? Kind::vertex_face : Kind::edge_edge,
        .judged = {}};
    cell.judged.queries = cell.judged.collisions = 1;
    jobs::MethodResult judged{.name = "planted", .timed = true, .judgement = {}};
    judged.judgement.queries = judged.judgement.collisions = 1;
    judged.judgement.toi_errors.add(numbers[i]);
    judged.judgement.nanoseconds = numbers[i];
    judged.judgement.checks = static_cast<std::uint64_t>(std::min(numbers[i], 1e15));
    judged.judgement.faults[static_cast<std::size_t>(judge::Fault::false_negative)] = i % 2;
    cell.judged.methods.push_back(judged);
    result.total += cell.judged;
    result.cells.push_back(cell);
  }
  return result;
}

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
  std::string page = stability_page(map_of(numbers_of_any_size), "touchstone stability");
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
}  // namespace touchstone::verify::report::page_browser_test

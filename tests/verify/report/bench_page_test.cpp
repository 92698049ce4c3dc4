/// \file
/// The page of a benchmark in a real browser: headless Chromium loads it from a file, runs its
/// script and returns the resulting document.

#include "verify/report/bench_page.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/browser_test.hpp"

namespace touchstone::verify::report::bench_page_test {
namespace {

class BenchPage : public tests::BrowserTest {};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++result;
  }
  return result;
}

/// A row of 100 judged queries, of which 20 collide, as `touchstone bench` writes it.
nlohmann::json row(const std::string& method, double nanoseconds, int false_positives = 0,
                   int false_negatives = 0) {
  return {{"source", "handcrafted"},
          {"kind", "vertex-face"},
          {"level", nullptr},
          {"method", method},
          {"tolerance", 1e-6},
          {"max_checks", 1000},
          {"min_separation", 0.0},
          {"norm", "l2"},
          {"timed", 100},
          {"judged", 100},
          {"collisions", 20},
          {"false_positives", false_positives},
          {"false_negatives", false_negatives},
          {"late_toi", 0},
          {"toi_error",
           {{"p50", 1e-9},
            {"max", method == "certified" ? nlohmann::json(1e-7) : nlohmann::json("Infinity")}}},
          {"ns_per_query", nanoseconds},
          {"certified_ns_per_query", 10.0}};
}

nlohmann::json at_level(int level, nlohmann::json of) {
  of.update({{"source", "near"}, {"level", level}});
  return of;
}

constexpr const char* reader = R"(<p id="found"></p><script>
const fronts = page.figures.flatMap((figure) => figure.panels.map((panel) => panel.front.map((point) => point.label).join("+")));
document.getElementById("found").textContent = JSON.stringify([page.figures.map((figure) => figure.title), fronts,
  page.pictureOf(page.figures[0]).includes("handcrafted, vertex-face"), document.querySelectorAll("h3").length]);
</script>)";

/// A curve over two tolerances, hollow marks of a method that misses, and the front of the others;
/// figures over the level; a name that would be markup.
TEST_F(BenchPage, DrawsSpeedAgainstErrorAndErrorOverTheLevel) {
  nlohmann::json rows = nlohmann::json::array(
      {row("certified", 10.0), row("inclusion", 2500.0, 8), row("mine<b>", 5.0, 1, 2)});
  nlohmann::json coarse = row("inclusion", 100.0, 40);
  coarse["tolerance"] = 1e-2;
  rows.push_back(coarse);
  for (const int level : {1, 2, 3}) rows.push_back(at_level(level, row("mine<b>", 5.0, 0, level)));
  rows.push_back({{"step", "frames"}});
  std::string page = bench_page(rows);
  page.insert(page.rfind("</body>"), reader);
  const std::string dom = load(page);
  EXPECT_EQ(complaints(), "");
  const std::string found = dom.substr(dom.find("<p id=\"found\">"));
  EXPECT_NE(found.find(R"([["Time a query against false positives",)"
                       R"("Time a query against the median error of the time of impact",)"
                       R"("Time a query against the greatest error of the time of impact",)"
                       R"("Misses over the level of difficulty",)"
                       R"("The greatest error of the time of impact over the level of difficulty",)"
                       R"("Time over the level of difficulty"],)"
                       R"(["certified","certified","certified","","",""],true,6])"),
            std::string::npos)
      << found;
  // Hollow: in three figures of speed, and at three levels in as many figures.
  EXPECT_EQ(count(dom, "fill: var(--paper); stroke-width: 1.6") +
                count(dom, "stroke-width: 1.6; fill: var(--paper)"),
            12U);
  EXPECT_EQ(count(dom, "<td class=\"missed\">✗ "), 4U);
  EXPECT_EQ(count(dom, "<b>"), 0U);
  EXPECT_NE(dom.find("∞"), std::string::npos);
}

}  // namespace
}  // namespace touchstone::verify::report::bench_page_test

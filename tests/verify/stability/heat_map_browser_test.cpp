/// \file
/// The map of stability in a real browser: what stands in a cell fits into it.

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/browser_test.hpp"
#include "verify/stability/heat_map.hpp"

namespace touchstone::verify::heat_map_browser_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class HeatMapBrowser : public tests::BrowserTest {};

/// A page with the picture, and a script that says below it how many texts stand in cells, and which
/// ones are wider than their cell.
std::string page_with(const std::string& picture) {
  return "<!DOCTYPE html><meta charset=\"utf-8\"><body>" + picture.substr(picture.find("<svg")) +
         R"(<p id="wide"></p><script>
const texts = Array.from(document.querySelectorAll("text.n"));
const isWide = (text) => text.getBBox().width > Number(text.previousElementSibling.getAttribute("width")) + 1;
document.getElementById("wide").textContent =
  `of ${texts.length} too wide: ${texts.filter(isWide).map((text) => text.textContent).join(" ")}.`;
</script>)";
}

/// A level for each number, as the error of the time of impact and as time in nanoseconds.
StabilityResult with_numbers(const std::vector<double>& numbers) {
  StabilityResult result;
  result.count = 1;
  const Hardness& hardness = hardness_from_name("distance");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    StabilityCell cell{.hardness = &hardness,
                       .exponent = hardness.exponents.at(i % hardness.exponents.size()),
                       .kind = i < hardness.exponents.size() ? Kind::vertex_face : Kind::edge_edge,
                       .judged = {}};
    cell.judged.queries = cell.judged.collisions = 1;
    MethodResult judged{.name = "planted", .timed = true, .judgement = {}};
    judged.judgement.queries = 1;
    judged.judgement.toi_errors.add(numbers[i]);
    judged.judgement.nanoseconds = numbers[i] < 1e15 ? numbers[i] : 1.0;
    judged.judgement.faults[static_cast<std::size_t>(Fault::false_negative)] = i % 2;
    cell.judged.methods.push_back(judged);
    result.total += cell.judged;
    result.cells.push_back(cell);
  }
  return result;
}

TEST_F(HeatMapBrowser, NumbersOfAnySizeFitIntoTheirCells) {
  const std::string dom = load(page_with(
      heat_map(with_numbers({0.0,    4.9e-324, 2.3e-308, 3e-100,  3.2e-13, 0.0123,  0.999,
                             1.5,    99.9,     999.6,    8.88e5,  9.996e5, 1e6,     1.2e8,
                             8.88e8, 9.996e8,  2.5e12,   8.88e99, 1e100,   1.7e308, infinity}))));
  EXPECT_EQ(complaints(), "");
  const std::size_t said = dom.find(R"(<p id="wide">of )");
  ASSERT_NE(said, std::string::npos) << dom;
  const std::string words = dom.substr(said, dom.find("</p>", said) - said);
  EXPECT_TRUE(words.ends_with(" too wide: .")) << words;
  EXPECT_EQ(words.find("of 0 "), std::string::npos) << words;
}

/// The script sees what is too wide.
TEST_F(HeatMapBrowser, APlantedFaultIsSeen) {
  std::string picture = heat_map(with_numbers({999.6}));
  const std::string text = ">1k</text>";
  ASSERT_NE(picture.find(text), std::string::npos);
  picture.replace(picture.find(text), text.size(), ">1000000k</text>");
  EXPECT_NE(load(page_with(picture)).find("too wide: 1000000k."), std::string::npos);
}

}  // namespace
}  // namespace touchstone::verify::heat_map_browser_test

#include "verify/report/figure.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace touchstone::verify::report::figure_test {
namespace {

using Places = std::vector<std::size_t>;

std::vector<FigurePoint> points(const std::vector<std::pair<double, double>>& places) {
  std::vector<FigurePoint> result;
  result.reserve(places.size());
  for (const auto& [x, y] : places) result.push_back({x, y, {}, false});
  return result;
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
  const auto field = points({{3, 1}, {1, 5}, {2, 3}, {4, 4}, {2, 4}, {5, 1}});
  EXPECT_EQ(pareto_front(field), (Places{1, 2, 0}));
}

TEST(ParetoFront, OfEqualPointsAllAreOnIt) {
  EXPECT_EQ(pareto_front(points({{1, 1}, {1, 1}, {1, 2}})), (Places{0, 1}));
}

TEST(ParetoFront, OnePointThatBeatsAllIsAlone) {
  EXPECT_EQ(pareto_front(points({{9, 9}, {1, 0}, {2, 0}, {1, 1}})), (Places{1}));
  EXPECT_EQ(pareto_front({}), Places{});
}

TEST(SeriesOf, FindsOrMakesIt) {
  FigurePanel panel;
  series_of(panel, "a", "curve", 3).points.push_back({1.0, 2.0, {}, false});
  EXPECT_EQ(series_of(panel, "a", "curve", 3).points.size(), 1U);
  EXPECT_EQ(series_of(panel, "a", "point", 3).slot, 3);
  EXPECT_EQ(panel.series.size(), 2U);
}

TEST(FigureJson, HasInfiniteNumbersAsWords) {
  Figure figure{.id = "id",
                .title = {},
                .description = {},
                .x_label = {},
                .y_label = {},
                .panels = {{}},
                .data = {}};
  series_of(figure.panels[0], "a", "curve", 0)
      .points.push_back({1.0, std::numeric_limits<double>::infinity(), {}, false});
  const nlohmann::json json = to_json({figure});
  EXPECT_EQ(json[0].at("form"), "lines");
  EXPECT_EQ(json[0].at("panels")[0].at("series")[0].at("points")[0].at("y"), "Infinity");
}

}  // namespace
}  // namespace touchstone::verify::report::figure_test

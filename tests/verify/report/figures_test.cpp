#include "verify/report/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::figures_test {
namespace {

const Figure& figure(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::ranges::find(figures, id, &Figure::id);
  if (found == figures.end()) throw std::invalid_argument(id);
  return *found;
}

const FigureSeries& series(const FigurePanel& panel, const std::string& name,
                           const std::string& role) {
  const auto found = std::ranges::find_if(panel.series, [&](const FigureSeries& candidate) {
    return candidate.name == name && candidate.role == role;
  });
  if (found == panel.series.end()) throw std::invalid_argument(name);
  return *found;
}

TEST(Figures, AreAllThereAndHaveTheirDataAsATable) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  std::set<std::string> ids;
  for (const Figure& one : figures) {
    ids.insert(one.id);
    EXPECT_FALSE(one.title.empty()) << one.id;
    EXPECT_FALSE(one.description.empty()) << one.id;
    EXPECT_FALSE(one.data.rows.empty()) << one.id;
    for (const auto& row : one.data.rows) EXPECT_EQ(row.size(), one.data.columns.size()) << one.id;
    for (const FigurePanel& panel : one.panels) EXPECT_FALSE(panel.series.empty()) << one.id;
  }
  const std::set<std::string> expected{
      "speed_false_positives", "speed_toi_median", "speed_toi_max",
      "running_times",         "tolerance_time",   "tolerance_false_positives",
      "separation_time",       "checks_early",     "checks_tolerance",
      "filter_misses",         "stages",           "stability",
      "stability_time"};
  EXPECT_EQ(ids, expected);
  EXPECT_EQ(figures.size(), expected.size());
}

TEST(Figures, SpeedAgainstErrorHasPointsCurvesAndTheFront) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const Figure& speed = figure(figures, "speed_false_positives");
  EXPECT_EQ(speed.form, FigureForm::points);
  ASSERT_EQ(speed.panels.size(), 1U);
  const FigurePanel& panel = speed.panels[0];
  EXPECT_EQ(panel.title, "handcrafted, vertex-face");
  ASSERT_EQ(series(panel, "tight_inclusion", "point").points.size(), 1U);
  EXPECT_EQ(series(panel, "tight_inclusion", "point").points[0],
            (FigurePoint{2500.0, 0.1, "tight_inclusion", false}));
  EXPECT_EQ(series(panel, "msrf", "point").points[0], (FigurePoint{400.0, 0.0125, "msrf", true}));
  const FigureSeries& curve = series(panel, "tight_inclusion", "curve");
  ASSERT_EQ(curve.points.size(), 2U);
  EXPECT_EQ(curve.points[1], (FigurePoint{1.0, 0.5, "δ = 1e+00", false}));
  EXPECT_EQ(curve.slot, series(panel, "tight_inclusion", "point").slot);
  ASSERT_EQ(panel.front.size(), 1U);
  EXPECT_EQ(panel.front[0].label, "certified");
  EXPECT_EQ(
      panel.caption,
      "On the front of those without a miss: certified. All were asked the same 100 queries.");
  EXPECT_EQ(speed.data.rows.size(), 5U);
}

TEST(Figures, MethodsWithFewerQueriesAreNamed) {
  Measurements measurements = tests::small_report();
  measurements.all[1].asked = 16;
  const std::vector<Figure> figures = figures_of(measurements);
  EXPECT_EQ(figure(figures, "speed_false_positives").panels.at(0).caption,
            "On the front of those without a miss: certified. Asked fewer of the 100 queries: "
            "tight_inclusion (16).");
  EXPECT_EQ(figure(figures, "checks_early").panels.at(0).caption,
            "Queries along a curve: tight_inclusion 100.");
}

TEST(Figures, MethodsWithoutTimesAreNotAmongTheErrorsOfTimes) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& panel = figure(figures, "speed_toi_max").panels.at(0);
  EXPECT_THROW(static_cast<void>(series(panel, "msrf", "point")), std::invalid_argument);
  EXPECT_EQ(series(panel, "certified", "point").points[0].y, 1e-13);
}

TEST(Figures, HistogramsAreSharesOfBothVerdicts) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& panel = figure(figures, "running_times").panels.at(0);
  const FigureSeries& hits = series(panel, "msrf", "collisions");
  ASSERT_EQ(hits.points.size(), 2U);
  EXPECT_DOUBLE_EQ(hits.points[0].x, 10.0);
  EXPECT_EQ(hits.points[0].y, 0.75);
  EXPECT_EQ(hits.points[1].y, 0.25);
  EXPECT_EQ(series(panel, "msrf", "no_collisions").points.at(0).y, 1.0);
}

TEST(Figures, CurvesStandOverTheirParameter) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& early = figure(figures, "checks_early").panels.at(0);
  EXPECT_EQ(series(early, "tight_inclusion", "curve").points.at(0),
            (FigurePoint{10.0, 0.25, "", false}));
  const FigurePanel& achieved = figure(figures, "checks_tolerance").panels.at(0);
  EXPECT_EQ(series(achieved, "greatest", "curve").points.at(0).y, 0.5);
  EXPECT_EQ(series(achieved, "median", "faint").points.at(0).y, 0.25);
  const FigurePanel& separation = figure(figures, "separation_time").panels.at(0);
  EXPECT_EQ(series(separation, "certified (L∞)", "curve").points.at(0).x, 1e-8);
  EXPECT_EQ(series(separation, "msrf", "curve").points.at(0).y, 30.0);
}

TEST(Figures, MissesStandOverTheScale) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const Figure& misses = figure(figures, "filter_misses");
  ASSERT_EQ(misses.panels.size(), 1U) << "the family has no scale";
  EXPECT_EQ(misses.panels[0].title, "contact at t=1, two decimals, vertex-face");
  EXPECT_EQ(series(misses.panels[0], "tight_inclusion_released", "curve").points.at(0),
            (FigurePoint{0.01, 0.1, "", true}));
  EXPECT_EQ(series(misses.panels[0], "tight_inclusion", "curve").points.at(0).y, 0.0);
}

TEST(Figures, StagesAndStabilityAreCellsAndShares) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& stages = figure(figures, "stages").panels.at(0);
  EXPECT_EQ(series(stages, "axis", "stage").points.at(0).x, 0.75);
  EXPECT_EQ(series(stages, "exact", "stage").points.at(0).label, "handcrafted, vertex-face");
  const FigurePanel& angle = figure(figures, "stability").panels.at(0);
  EXPECT_EQ(angle.title, "angle");
  EXPECT_EQ(series(angle, "msrf", "ee").points.at(0),
            (FigurePoint{-5.0, 0.4, "N", true,
                         "20 queries, 10 collisions, 4 false negatives\n7 ns a query"}));
}

TEST(Figures, WithoutMeasurementsThereAreNone) { EXPECT_TRUE(figures_of({}).empty()); }

TEST(Figures, AreJsonForTheScript) {
  const nlohmann::json json = to_json(figures_of(tests::small_report()));
  ASSERT_EQ(json.size(), 13U);
  EXPECT_EQ(json[0].at("id"), "speed_false_positives");
  EXPECT_EQ(json[0].at("form"), "points");
  EXPECT_EQ(json[0].at("x_log"), true);
  const nlohmann::json& panel = json[0].at("panels")[0];
  EXPECT_EQ(panel.at("front")[0].at("label"), "certified");
  EXPECT_EQ(panel.at("series").size(), 4U);
}

}  // namespace
}  // namespace touchstone::verify::report::figures_test

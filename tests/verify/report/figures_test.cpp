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

TEST(Figures, WhoWasAskedLessIsNamed) {
  Measurements measurements = tests::small_report();
  measurements.all[1].asked = 16;
  const std::vector<Figure> figures = figures_of(measurements);
  EXPECT_EQ(figure(figures, "speed_false_positives").panels.at(0).caption,
            "On the front of those without a miss: certified. Asked fewer of the 100 queries: "
            "tight_inclusion (16).");
  EXPECT_EQ(figure(figures, "checks_early").panels.at(0).caption,
            "Queries along a curve: tight_inclusion 100.");
}

TEST(Figures, WhoGivesNoTimeIsNotAmongTheErrorsOfTimes) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& panel = figure(figures, "speed_toi_max").panels.at(0);
  EXPECT_THROW(static_cast<void>(series(panel, "msrf", "point")), std::invalid_argument);
  EXPECT_EQ(series(panel, "certified", "point").points[0].y, 1e-13);
}

TEST(Figures, HistogramsAreSharesOfHitsAndMisses) {
  const std::vector<Figure> figures = figures_of(tests::small_report());
  const FigurePanel& panel = figure(figures, "running_times").panels.at(0);
  const FigureSeries& hits = series(panel, "msrf", "hits");
  ASSERT_EQ(hits.points.size(), 2U);
  EXPECT_DOUBLE_EQ(hits.points[0].x, 10.0);
  EXPECT_EQ(hits.points[0].y, 0.75);
  EXPECT_EQ(hits.points[1].y, 0.25);
  EXPECT_EQ(series(panel, "msrf", "misses").points.at(0).y, 1.0);
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

TEST(Figures, WhatIsInfiniteIsAWordForTheScript) {
  Measurements measurements = tests::small_report();
  for (Measurement& m : measurements.all) {
    if (m.achieved_tolerance) {
      m.achieved_tolerance->max = std::numeric_limits<double>::infinity();
    }
  }
  for (const nlohmann::json& one : to_json(figures_of(measurements))) {
    if (one.at("id") != "checks_tolerance") continue;
    EXPECT_EQ(one.at("panels")[0].at("series")[0].at("points")[0].at("y"), "Infinity");
    return;
  }
  FAIL() << "no such figure";
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

TEST(Figures, EveryFaultHasALetter) {
  Measurements measurements;
  using judge::Fault;
  for (const std::optional<Fault> worst :
       std::initializer_list<std::optional<Fault>>{{},
                                                   Fault::false_positive,
                                                   Fault::false_negative,
                                                   Fault::late_toi,
                                                   Fault::early_toi_upper,
                                                   Fault::no_verdict,
                                                   Fault::beyond_tolerance}) {
    measurements.stability.push_back(
        {.method = "m", .hardness = "angle", .measure = {}, .worst = worst});
  }
  std::string letters;
  const std::vector<Figure> figures = figures_of(measurements);
  for (const FigurePoint& point : figures.at(0).panels.at(0).series.at(0).points) {
    letters += point.label.empty() ? "." : point.label;
  }
  EXPECT_EQ(letters, ".PNTTEB");
}

TEST(Figures, ErrorsAndHangsAreMarkedBesideTheWorst) {
  Measurements measurements;
  const auto add = [&](std::optional<judge::Fault> worst, std::uint64_t errors,
                       std::uint64_t hangs) {
    measurements.stability.push_back({.method = "m",
                                      .hardness = "digits",
                                      .measure = {},
                                      .is_power = false,
                                      .errors = errors,
                                      .hangs = hangs,
                                      .worst = worst});
  };
  add(judge::Fault::false_negative, 1, 0);
  add(judge::Fault::false_positive, 0, 2);
  add(judge::Fault::crash, 3, 0);
  add(judge::Fault::crash, 3, 1);
  add({}, 0, 1);
  const std::vector<Figure> figures = figures_of(measurements);
  const FigurePanel& panel = figures.at(0).panels.at(0);
  EXPECT_FALSE(panel.powers);
  std::string letters;
  for (const FigurePoint& point : panel.series.at(0).points) letters += point.label + " ";
  EXPECT_EQ(letters, "N! P! E E! ! ");
}

TEST(Figures, StabilityShowsTheNumbersOfThoseThatGiveThem) {
  Measurements measurements = tests::small_report();
  StabilityMark counting = measurements.stability.at(0);
  counting.method = "certified";
  counting.checks = 2.5;
  counting.toi_error = Spread{.count = 3, .median = 0.0, .max = 1e-13};
  measurements.stability.push_back(counting);
  counting.exponent = -10;
  counting.toi_error.reset();
  measurements.stability.push_back(counting);
  const std::vector<Figure> figures = figures_of(measurements);
  const Figure& checks = figure(figures, "stability_checks");
  EXPECT_EQ(checks.form, FigureForm::shades);
  ASSERT_EQ(checks.panels.at(0).series.size(), 1U) << "msrf does not count";
  EXPECT_EQ(checks.panels[0].series[0].points.at(0), (FigurePoint{-5.0, 2.5, "", false}));
  EXPECT_EQ(figure(figures, "stability_time").panels.at(0).series.size(), 2U);
  const FigureSeries& median = figure(figures, "stability_toi_median").panels.at(0).series.at(0);
  EXPECT_EQ(median.points.at(0).y, 0.0);
  EXPECT_TRUE(std::isnan(median.points.at(1).y)) << "not known at this level";
  EXPECT_EQ(figure(figures, "stability_toi_max").data.rows.at(0),
            (std::vector<std::string>{"angle", "angle to parallel", "-5", "edge-edge", "certified",
                                      "1e-13"}));
}

TEST(Figures, StabilityHasTheRowsOfAMethodSideBySide) {
  Measurements measurements;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const char* const method : {"first", "second"}) {
      measurements.stability.push_back({.method = method,
                                        .hardness = "angle",
                                        .measure = {},
                                        .exponent = 0,
                                        .kind = kind,
                                        .worst = {}});
    }
  }
  const std::vector<Figure> figures = figures_of(measurements);
  std::string rows;
  for (const FigureSeries& one : figures.at(0).panels.at(0).series) {
    rows += one.name + " " + one.role + "; ";
  }
  EXPECT_EQ(rows, "first vf; first ee; second vf; second ee; ");
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

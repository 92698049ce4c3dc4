#include "verify/report/stability_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::stability_figures_test {
namespace {

const MethodSlots slots{{"certified", 0}, {"msrf", 1}, {"m", 2}, {"first", 3}, {"second", 4}};

const Figure& figure(const std::vector<Figure>& figures, const std::string& id) {
  const auto found = std::ranges::find(figures, id, &Figure::id);
  if (found == figures.end()) throw std::invalid_argument(id);
  return *found;
}

TEST(StabilityFigures, EveryFaultHasALetter) {
  std::vector<StabilityMark> marks;
  using judge::Fault;
  for (const std::optional<Fault> worst :
       std::initializer_list<std::optional<Fault>>{{},
                                                   Fault::false_positive,
                                                   Fault::false_negative,
                                                   Fault::late_toi,
                                                   Fault::early_toi_upper,
                                                   Fault::no_verdict,
                                                   Fault::beyond_tolerance}) {
    marks.push_back({.method = "m", .hardness = "angle", .measure = {}, .worst = worst});
  }
  std::string letters;
  const std::vector<Figure> figures = stability_figures(marks, slots);
  for (const FigurePoint& point : figures.at(0).panels.at(0).series.at(0).points) {
    letters += point.label.empty() ? "." : point.label;
  }
  EXPECT_EQ(letters, ".PNTTEB");
}

TEST(StabilityFigures, ErrorsAndHangsAreMarkedBesideTheWorst) {
  std::vector<StabilityMark> marks;
  const auto add = [&](std::optional<judge::Fault> worst, std::uint64_t errors,
                       std::uint64_t hangs) {
    marks.push_back({.method = "m",
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
  const std::vector<Figure> figures = stability_figures(marks, slots);
  const FigurePanel& panel = figures.at(0).panels.at(0);
  EXPECT_FALSE(panel.powers);
  std::string letters;
  for (const FigurePoint& point : panel.series.at(0).points) letters += point.label + " ";
  EXPECT_EQ(letters, "N! P! E E! ! ");
}

TEST(StabilityFigures, StabilityShowsTheNumbersOfThoseThatGiveThem) {
  std::vector<StabilityMark> marks = tests::small_report().stability;
  StabilityMark counting = marks.at(0);
  counting.method = "certified";
  counting.checks = 2.5;
  counting.toi_error = Spread{.count = 3, .median = 0.0, .max = 1e-13};
  marks.push_back(counting);
  counting.exponent = -10;
  counting.toi_error.reset();
  marks.push_back(counting);
  const std::vector<Figure> figures = stability_figures(marks, slots);
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

TEST(StabilityFigures, StabilityHasTheRowsOfAMethodSideBySide) {
  std::vector<StabilityMark> marks;
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    for (const char* const method : {"first", "second"}) {
      marks.push_back({.method = method,
                       .hardness = "angle",
                       .measure = {},
                       .exponent = 0,
                       .kind = kind,
                       .worst = {}});
    }
  }
  const std::vector<Figure> figures = stability_figures(marks, slots);
  std::string rows;
  for (const FigureSeries& one : figures.at(0).panels.at(0).series) {
    rows += one.name + " " + one.role + "; ";
  }
  EXPECT_EQ(rows, "first vf; first ee; second vf; second ee; ");
}

TEST(StabilityFigures, AreOmittedWithoutMarks) {
  EXPECT_TRUE(stability_figures({}, slots).empty());
}

}  // namespace
}  // namespace touchstone::verify::report::stability_figures_test

#include "verify/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "verify/report/stability_figures.hpp"
#include "verify/report/tables.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

using Chosen = std::vector<const Measurement*>;
using Texts = std::vector<std::string>;
using Value = std::function<double(const Measurement&)>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string place_of(const Measurement& m) {
  return fmt::format("{}, {}", m.group, to_string(m.kind));
}

double time_of(const Measurement& m) { return m.nanoseconds; }

bool is_linf(const Measurement& m) { return m.separation.norm == Norm::linf; }

bool measures_in_both_norms(std::string_view method) {
  const fast::MethodInfo* const info = solvers::find_info(method);
  return info != nullptr && info->measures_in(Norm::linf) && info->measures_in(Norm::l2);
}

/// Has it given an answer that a conservative method must not give?
bool misses(const Measurement& m) { return m.false_negatives + m.late_tois != 0; }

std::string with_limits(const std::string& text) {
  return text +
         " Hollow: there the method misses collisions, or gives times of impact after the exact "
         "one.";
}

class Builder {
 public:
  explicit Builder(const Measurements& measurements) : measurements_(measurements) {
    for (const Measurement& m : measurements.all) slot_of(m.method);
    for (const StabilityMark& mark : measurements.stability) slot_of(mark.method);
  }

  std::vector<Figure> figures() {
    add_speed_against_error();
    add_times();
    add_tolerance();
    add_separation();
    add_checks();
    add_filters();
    add_stages();
    std::ranges::move(stability_figures(measurements_.stability, slots_),
                      std::back_inserter(figures_));
    return std::move(figures_);
  }

 private:
  /// The number of a method among those of the report.
  int slot_of(const std::string& method) {
    return slots_.try_emplace(method, static_cast<int>(slots_.size())).first->second;
  }

  void add(Figure figure) {
    std::erase_if(figure.panels, [](const FigurePanel& panel) { return panel.series.empty(); });
    if (!figure.panels.empty()) figures_.push_back(std::move(figure));
  }

  /// The measurements of an experiment by group and kind, in their order.
  [[nodiscard]] std::vector<std::pair<std::string, Chosen>> by_place(Experiment experiment) const {
    std::vector<std::pair<std::string, Chosen>> places;
    for (const Measurement* m : of_experiment(measurements_, experiment)) {
      const std::string place = place_of(*m);
      auto found = std::ranges::find(places, place, &std::pair<std::string, Chosen>::first);
      if (found == places.end()) {
        places.emplace_back(place, Chosen{});
        found = std::prev(places.end());
      }
      found->second.push_back(m);
    }
    return places;
  }

  // ---- Speed against error ----------------------------------------------------------------------

  void add_speed_against_error() {
    add_points("speed_false_positives", "Time a query against false positives",
               "false positives, of the queries that do not collide", false_positive_rate);
    add_points("speed_toi_median", "Time a query against the median error of the time of impact",
               "error of the time of impact, median",
               [](const Measurement& m) { return m.toi_error ? m.toi_error->median : nan; });
    add_points("speed_toi_max", "Time a query against the greatest error of the time of impact",
               "error of the time of impact, greatest",
               [](const Measurement& m) { return m.toi_error ? m.toi_error->max : nan; });
  }

  void add_points(const std::string& id, const std::string& title, const std::string& y_label,
                  const Value& error) {
    Figure figure{.id = id,
                  .title = title,
                  .description = with_limits(
                      "A point a method; a curve for those that aim at a tolerance, δ from 1e-8 to "
                      "1. Down and to the left is better. Dashed: the Pareto front of the methods "
                      "that miss nothing."),
                  .form = FigureForm::points,
                  .x_label = "time a query, ns",
                  .y_label = y_label,
                  .panels = {},
                  .data = {{},
                           {"group", "kind", "method", "tolerance", "ns_per_query", id,
                            "false_negatives", "late_tois", "asked", "at_limit", "on_front"},
                           {}}};
    const auto curves = by_place(Experiment::tolerance);
    for (const auto& [place, chosen] : by_place(Experiment::field)) {
      FigurePanel panel{.title = place, .caption = {}, .series = {}, .front = {}};
      for (const auto& [curve_place, of_curves] : curves) {
        if (curve_place == place) add_curves(of_curves, error, panel, figure.data);
      }
      add_methods(chosen, error, panel, figure.data);
      figure.panels.push_back(std::move(panel));
    }
    add(std::move(figure));
  }

  /// Recorded answers have no times.
  static bool is_placed(const Measurement& m, const Value& error) {
    return !std::isnan(error(m)) && !std::isnan(m.nanoseconds);
  }

  void add_curves(const Chosen& chosen, const Value& error, FigurePanel& panel, Table& data) {
    for (const Measurement* m : chosen) {
      if (!is_placed(*m, error)) continue;
      FigureSeries& series = series_of(panel, m->method, "curve");
      series.points.push_back(
          {m->nanoseconds, error(*m), fmt::format("δ = {:.0e}", m->tolerance), misses(*m)});
      add_error_row(*m, error(*m), false, data);
    }
  }

  void add_methods(const Chosen& chosen, const Value& error, FigurePanel& panel, Table& data) {
    std::vector<FigurePoint> eligible;
    for (const Measurement* m : chosen) {
      if (!is_placed(*m, error)) continue;
      const FigurePoint point{m->nanoseconds, error(*m), m->method, misses(*m)};
      series_of(panel, m->method, "point").points.push_back(point);
      if (!point.open) eligible.push_back(point);
    }
    for (const std::size_t i : pareto_front(eligible)) panel.front.push_back(eligible[i]);
    panel.caption = front_sentence(panel.front) + sample_sentence(chosen);
    for (const Measurement* m : chosen) {
      if (!is_placed(*m, error)) continue;
      const bool on_front = std::ranges::any_of(
          panel.front, [&](const FigurePoint& point) { return point.label == m->method; });
      add_error_row(*m, error(*m), on_front, data);
    }
  }

  static std::string front_sentence(const std::vector<FigurePoint>& front) {
    if (front.empty()) return "No method here is without a miss.";
    std::string names;
    for (const FigurePoint& point : front) {
      names += (names.empty() ? "" : ", ") + point.label;
    }
    return fmt::format("On the front of those without a miss: {}.", names);
  }

  /// Which methods were asked fewer queries than others; empty if none was.
  static std::string sample_sentence(const Chosen& chosen) {
    std::uint64_t most = 0;
    for (const Measurement* m : chosen) most = std::max(most, m->asked);
    std::string fewer;
    for (const Measurement* m : chosen) {
      if (m->asked == most) continue;
      fewer += fmt::format("{}{} ({})", fewer.empty() ? "" : ", ", m->method, m->asked);
    }
    return fewer.empty() ? fmt::format(" All were asked the same {} queries.", most)
                         : fmt::format(" Asked fewer of the {} queries: {}.", most, fewer);
  }

  /// Number of queries behind the curves.
  static std::string sample_sentence_of_curves(const Chosen& chosen) {
    std::map<std::string, std::uint64_t> asked;
    for (const Measurement* m : chosen) asked[m->method] = m->asked;
    std::string text;
    for (const auto& [method, count] : asked) {
      text +=
          fmt::format("{}{} {}", text.empty() ? "Queries along a curve: " : ", ", method, count);
    }
    return text + ".";
  }

  static void add_error_row(const Measurement& m, double error, bool on_front, Table& data) {
    data.rows.push_back({m.group, std::string(to_string(m.kind)), m.method,
                         fmt::format("{}", m.tolerance), fmt::format("{}", m.nanoseconds),
                         fmt::format("{}", error), fmt::format("{}", m.false_negatives),
                         fmt::format("{}", m.late_tois), fmt::format("{}", m.asked),
                         fmt::format("{}", m.at_limit), on_front ? "1" : "0"});
  }

  FigureSeries& series_of(FigurePanel& panel, const std::string& method, const std::string& role,
                          const std::string& name = {}) {
    return report::series_of(panel, name.empty() ? method : name, role, slot_of(method));
  }

  // ---- Running times ----------------------------------------------------------------------------

  void add_times() {
    Figure figure{
        .id = "running_times",
        .title = "Running times of single queries",
        .description =
            "How the times of single calls are spread: above each method's line for queries "
            "that do not collide, below it for those that do. Heights are square roots of "
            "shares, so that the rare is seen. One call a query takes longer than its part "
            "of a call for many.",
        .form = FigureForm::ridges,
        .x_label = "time of one call, ns",
        .y_label = "share of queries",
        .y_log = false,
        .panels = {},
        .data = {{}, {"group", "kind", "method", "collide", "from_ns", "to_ns", "queries"}, {}}};
    for (const auto& [place, chosen] : by_place(Experiment::field)) {
      FigurePanel panel{.title = place, .caption = {}, .series = {}, .front = {}};
      for (const Measurement* m : chosen) {
        if (m->collision_times.count() + m->no_collision_times.count() == 0) continue;
        add_histogram(*m, m->no_collision_times, "no_collisions", panel, figure.data);
        add_histogram(*m, m->collision_times, "collisions", panel, figure.data);
      }
      figure.panels.push_back(std::move(panel));
    }
    add(std::move(figure));
  }

  void add_histogram(const Measurement& m, const TimeHistogram& times, const std::string& role,
                     FigurePanel& panel, Table& data) {
    FigureSeries& series = series_of(panel, m.method, role);
    const auto all = static_cast<double>(times.count());
    for (const auto& [bin, count] : times.bins) {
      const double from = TimeHistogram::lower_end(bin);
      series.points.push_back({from, static_cast<double>(count) / all, {}, false});
      data.rows.push_back({m.group, std::string(to_string(m.kind)), m.method,
                           role == "collisions" ? "1" : "0", fmt::format("{:.6g}", from),
                           fmt::format("{:.6g}", TimeHistogram::lower_end(bin + 1)),
                           fmt::format("{}", count)});
    }
  }

  // ---- Curves over a parameter ------------------------------------------------------------------

  struct Curve {
    Experiment experiment;
    std::string parameter;  ///< its column of the data
    Value x;
    std::string measure;  ///< its column of the data
    Value y;
    /// Which series a measurement belongs to: its method and this.
    std::function<std::string(const Measurement&)> suffix;
  };

  void add_lines(Figure figure, const Curve& curve) {
    figure.form = FigureForm::lines;
    figure.data.columns = {"group",         "kind",        "method",          "norm",
                           curve.parameter, curve.measure, "false_negatives", "asked",
                           "at_limit"};
    for (const auto& [place, chosen] : by_place(curve.experiment)) {
      FigurePanel panel{
          .title = place, .caption = sample_sentence_of_curves(chosen), .series = {}, .front = {}};
      for (const Measurement* m : chosen) {
        const double y = curve.y(*m);
        if (std::isnan(y)) continue;
        series_of(panel, m->method, "curve", m->method + curve.suffix(*m))
            .points.push_back({curve.x(*m), y, {}, misses(*m)});
        figure.data.rows.push_back({m->group, std::string(to_string(m->kind)), m->method,
                                    std::string(to_string(m->separation.norm)),
                                    fmt::format("{}", curve.x(*m)), fmt::format("{}", y),
                                    fmt::format("{}", m->false_negatives),
                                    fmt::format("{}", m->asked), fmt::format("{}", m->at_limit)});
      }
      figure.panels.push_back(std::move(panel));
    }
    add(std::move(figure));
  }

  static std::string no_suffix(const Measurement&) { return {}; }

  void add_tolerance() {
    const Value tolerance = [](const Measurement& m) { return m.tolerance; };
    Figure time{.id = "tolerance_time",
                .title = "Time over the tolerance δ",
                .description = "Of the methods that aim at a tolerance.",
                .x_label = "tolerance δ, in units of the coordinates",
                .y_label = "time a query, ns",
                .panels = {},
                .data = {}};
    add_lines(std::move(time),
              {Experiment::tolerance, "tolerance", tolerance, "ns_per_query", time_of, no_suffix});
    Figure error{.id = "tolerance_false_positives",
                 .title = "False positives over the tolerance δ",
                 .description = "Of the same methods, of the queries that do not collide.",
                 .x_label = "tolerance δ, in units of the coordinates",
                 .y_label = "false positives",
                 .panels = {},
                 .data = {}};
    add_lines(std::move(error), {Experiment::tolerance, "tolerance", tolerance,
                                 "false_positive_rate", false_positive_rate, no_suffix});
  }

  void add_separation() {
    Figure figure{.id = "separation_time",
                  .title = "Time over the minimum separation d",
                  .description = with_limits(
                      "Each method in its own norm, the certified solver in both; the truth is "
                      "about the same distance."),
                  .x_label = "minimum separation d, in units of the coordinates",
                  .y_label = "time a query, ns",
                  .x_even = true,
                  .panels = {},
                  .data = {}};
    add_lines(std::move(figure),
              {Experiment::separation, "min_separation",
               [](const Measurement& m) { return m.separation.distance; }, "ns_per_query", time_of,
               [](const Measurement& m) -> std::string {
                 if (!measures_in_both_norms(m.method)) return {};
                 return is_linf(m) ? " (L∞)" : " (L2)";
               }});
  }

  void add_checks() {
    const Value limit = [](const Measurement& m) { return static_cast<double>(m.max_checks); };
    Figure share{.id = "checks_early",
                 .title = "Early termination over the maximum number of checks m_I",
                 .description =
                     "Share of the queries that Tight-Inclusion gives up at m_I checks, and "
                     "calls a collision.",
                 .x_label = "maximum number of checks m_I",
                 .y_label = "share of queries",
                 .panels = {},
                 .data = {}};
    add_lines(std::move(share), {Experiment::checks, "max_checks", limit, "share_at_limit",
                                 [](const Measurement& m) {
                                   return static_cast<double>(m.at_limit) /
                                          static_cast<double>(m.asked);
                                 },
                                 no_suffix});
    Figure achieved{.id = "checks_tolerance",
                    .title = "Achieved δ over the maximum number of checks m_I",
                    .description =
                        "The tolerance that Tight-Inclusion's collisions claim (asked: "
                        "1e-6), the greatest and the median.",
                    .x_label = "maximum number of checks m_I",
                    .y_label = "achieved δ, in units of the coordinates",
                    .panels = {},
                    .data = {}};
    add_achieved(std::move(achieved));
  }

  void add_achieved(Figure figure) {
    figure.data.columns = {
        "group",           "kind",        "method", "max_checks", "collisions_claimed",
        "achieved_median", "achieved_max"};
    for (const auto& [place, chosen] : by_place(Experiment::checks)) {
      FigurePanel panel{
          .title = place, .caption = sample_sentence_of_curves(chosen), .series = {}, .front = {}};
      for (const Measurement* m : chosen) {
        if (!m->achieved_tolerance) continue;
        const auto x = static_cast<double>(m->max_checks);
        const Spread& achieved = *m->achieved_tolerance;
        series_of(panel, m->method, "curve", "greatest")
            .points.push_back({x, achieved.max, {}, false});
        series_of(panel, m->method, "faint", "median")
            .points.push_back({x, achieved.median, {}, false});
        figure.data.rows.push_back(
            {m->group, std::string(to_string(m->kind)), m->method, fmt::format("{}", m->max_checks),
             fmt::format("{}", achieved.count), fmt::format("{}", achieved.median),
             fmt::format("{}", achieved.max)});
      }
      figure.panels.push_back(std::move(panel));
    }
    add(std::move(figure));
  }

  void add_filters() {
    Figure figure{.id = "filter_misses",
                  .title = "What Tight-Inclusion misses with each filter, over the scale",
                  .description = std::string(filter_sentence()),
                  .x_label = "greatest coordinate",
                  .y_label = "contacts missed, of all",
                  .y_log = false,
                  .panels = {},
                  .data = {}};
    add_lines(
        std::move(figure),
        {Experiment::filter, "scale", [](const Measurement& m) { return m.scale.value_or(nan); },
         "false_negative_rate",
         [](const Measurement& m) { return m.scale ? false_negative_rate(m) : nan; }, no_suffix});
  }

  // ---- Stages -----------------------------------------------------------------------------------

  void add_stages() {
    Figure figure{.id = "stages",
                  .title = "Which stage ends a query of the certified solver",
                  .description = "Share of the queries that each stage ends, cheapest first.",
                  .form = FigureForm::bars,
                  .x_label = "share of queries",
                  .y_label = {},
                  .x_log = false,
                  .y_log = false,
                  .panels = {},
                  .data = {{}, {"group", "kind", "stage", "queries", "asked"}, {}}};
    FigurePanel panel{.title = std::string(fast::certified_info().name),
                      .caption = {},
                      .series = {},
                      .front = {}};
    for (const Measurement* m : of_experiment(measurements_, Experiment::field)) {
      for (std::size_t i = 0; i < m->stages.size(); ++i) {
        const auto& [stage, queries] = m->stages[i];
        if (panel.series.size() <= i) {
          panel.series.push_back(
              {.name = stage, .role = "stage", .slot = static_cast<int>(i), .points = {}});
        }
        panel.series[i].points.push_back(
            {static_cast<double>(queries) / static_cast<double>(m->asked), 0.0, place_of(*m),
             false});
        figure.data.rows.push_back({m->group, std::string(to_string(m->kind)), stage,
                                    fmt::format("{}", queries), fmt::format("{}", m->asked)});
      }
    }
    figure.panels.push_back(std::move(panel));
    add(std::move(figure));
  }

  const Measurements& measurements_;
  MethodSlots slots_;
  std::vector<Figure> figures_;
};

}  // namespace

std::vector<Figure> figures_of(const Measurements& measurements) {
  return Builder(measurements).figures();
}

}  // namespace touchstone::verify::report

#include "verify/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "fast/certified.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/json.hpp"
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
    add_stability();
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
    const std::string& shown = name.empty() ? method : name;
    const auto is_it = [&](const FigureSeries& s) { return s.name == shown && s.role == role; };
    const auto found = std::ranges::find_if(panel.series, is_it);
    if (found != panel.series.end()) return *found;
    return panel.series.emplace_back(
        FigureSeries{.name = shown, .role = role, .slot = slot_of(method), .points = {}});
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
        if (m->hit_times.count() + m->miss_times.count() == 0) continue;
        add_histogram(*m, m->miss_times, "misses", panel, figure.data);
        add_histogram(*m, m->hit_times, "hits", panel, figure.data);
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
                           role == "hits" ? "1" : "0", fmt::format("{:.6g}", from),
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
                  .description = std::string(released_filter_sentence()),
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

  // ---- Stages and stability ---------------------------------------------------------------------

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

  /// The letter of the worst fault if there is one, and "!" where there are errors or hangs besides.
  static std::string mark_text(const StabilityMark& mark) {
    std::string text;
    if (mark.worst) text += judge::letter_of(*mark.worst);
    const bool is_error = mark.worst && judge::is_error(*mark.worst);
    if (mark.hangs != 0 || (mark.errors != 0 && !is_error)) text += '!';
    return text;
  }

  static std::string row_of(const StabilityMark& mark) {
    return mark.kind == Kind::vertex_face ? "vf" : "ee";
  }

  /// Appends ", 3 false negatives" if there are some.
  static void append_count(std::string& text, std::uint64_t count, std::string_view what) {
    if (count != 0) text += fmt::format(", {} {}", count, what);
  }

  /// All there is to say of a cell.
  static std::string tip_of(const StabilityMark& mark) {
    std::string text = fmt::format("{} queries, {} collisions", mark.queries, mark.collisions);
    append_count(text, mark.false_negatives, "false negatives");
    append_count(text, mark.false_positives, "false positives");
    append_count(text, mark.late_tois, "late times of impact");
    append_count(text, mark.early_upper_tois, "early upper times of impact");
    append_count(text, mark.beyond_tolerance, "beyond the tolerance");
    append_count(text, mark.errors, "errors");
    append_count(text, mark.undecided, "undecided");
    append_count(text, mark.hangs, "of them hangs");
    if (mark.toi_error) {
      text += fmt::format("\nerror of the time of impact: median {}, greatest {}",
                          short_number(mark.toi_error->median), short_number(mark.toi_error->max));
    }
    if (!std::isnan(mark.nanoseconds)) text += fmt::format("\n{:.0f} ns a query", mark.nanoseconds);
    if (!std::isnan(mark.checks)) text += fmt::format("\n{:.1f} checks a query", mark.checks);
    return text;
  }

  /// The panel of a mark's hardness, made where there is none.
  static FigurePanel& panel_of(Figure& figure, const StabilityMark& mark) {
    const auto found = std::ranges::find(figure.panels, mark.hardness, &FigurePanel::title);
    if (found != figure.panels.end()) return *found;
    return figure.panels.emplace_back(FigurePanel{.title = mark.hardness,
                                                  .caption = mark.measure,
                                                  .powers = mark.is_power,
                                                  .series = {},
                                                  .front = {}});
  }

  /// With the rows of a method side by side.
  void add_grid(Figure figure) {
    for (FigurePanel& panel : figure.panels) {
      std::ranges::stable_sort(panel.series, {}, &FigureSeries::slot);
    }
    add(std::move(figure));
  }

  void add_stability() {
    Figure figure{
        .id = "stability",
        .title = "Stability: what goes wrong as queries get harder",
        .description =
            "A cell a level of hardness: the worst that happens at it, and how often, in percent. "
            "N: "
            "false negatives, of the collisions. T: the time of impact excludes the true "
            "one, of the collisions. E: errors. B: a yes beyond its tolerance, of the misses. "
            "Shades: false positives, of the misses, the deeper the more. Pale and empty: every "
            "answer "
            "is right. !: errors or hangs besides. vf: vertex-face. ee: edge-edge.",
        .form = FigureForm::marks,
        .x_label = "level",
        .y_label = {},
        .x_log = false,
        .y_log = false,
        .panels = {},
        .data = {{},
                 {"hardness", "measure", "level", "kind", "method", "queries", "collisions",
                  "false_positives", "false_negatives", "late_tois", "early_upper_tois",
                  "beyond_tolerance", "errors", "hangs", "undecided", "worst", "worst_rate",
                  "ns_per_query"},
                 {}}};
    for (const StabilityMark& mark : measurements_.stability) {
      series_of(panel_of(figure, mark), mark.method, row_of(mark))
          .points.push_back({static_cast<double>(mark.exponent), mark.worst_rate, mark_text(mark),
                             mark.worst == judge::Fault::false_negative, tip_of(mark)});
      figure.data.rows.push_back(
          {mark.hardness, mark.measure, fmt::format("{}", mark.exponent),
           std::string(to_string(mark.kind)), mark.method, fmt::format("{}", mark.queries),
           fmt::format("{}", mark.collisions), fmt::format("{}", mark.false_positives),
           fmt::format("{}", mark.false_negatives), fmt::format("{}", mark.late_tois),
           fmt::format("{}", mark.early_upper_tois), fmt::format("{}", mark.beyond_tolerance),
           fmt::format("{}", mark.errors), fmt::format("{}", mark.hangs),
           fmt::format("{}", mark.undecided),
           std::string(mark.worst ? judge::to_text(*mark.worst) : ""),
           fmt::format("{}", mark.worst_rate), io::csv_number(mark.nanoseconds)});
    }
    add_grid(std::move(figure));
    add_stability_of("stability_toi_median", "Stability: the median error of the time of impact",
                     "error of the time of impact, median", [](const StabilityMark& mark) {
                       return mark.toi_error ? mark.toi_error->median : nan;
                     });
    add_stability_of("stability_toi_max", "Stability: the greatest error of the time of impact",
                     "error of the time of impact, greatest", [](const StabilityMark& mark) {
                       return mark.toi_error ? mark.toi_error->max : nan;
                     });
    add_stability_of("stability_time", "Stability: the time a query", "time a query, ns",
                     [](const StabilityMark& mark) { return mark.nanoseconds; });
    add_stability_of("stability_checks", "Stability: the checks a query", "checks a query",
                     [](const StabilityMark& mark) { return mark.checks; });
  }

  /// A number of each cell, of the methods that give it.
  void add_stability_of(const std::string& id, const std::string& title, const std::string& y_label,
                        double (*value)(const StabilityMark&)) {
    Figure figure{.id = id,
                  .title = title,
                  .description =
                      "A cell a level of hardness, the deeper the greater the number. "
                      "Framed: not known. vf: vertex-face. ee: edge-edge.",
                  .form = FigureForm::shades,
                  .x_label = "level",
                  .y_label = y_label,
                  .x_log = false,
                  .panels = {},
                  .data = {{}, {"hardness", "measure", "level", "kind", "method", id}, {}}};
    std::set<std::string> giving;
    for (const StabilityMark& mark : measurements_.stability) {
      if (!std::isnan(value(mark))) giving.insert(mark.method);
    }
    for (const StabilityMark& mark : measurements_.stability) {
      if (!giving.contains(mark.method)) continue;
      const double number = value(mark);
      series_of(panel_of(figure, mark), mark.method, row_of(mark))
          .points.push_back({static_cast<double>(mark.exponent), number, {}, false});
      figure.data.rows.push_back({mark.hardness, mark.measure, fmt::format("{}", mark.exponent),
                                  std::string(to_string(mark.kind)), mark.method,
                                  io::csv_number(number)});
    }
    add_grid(std::move(figure));
  }

  const Measurements& measurements_;
  std::map<std::string, int> slots_;
  std::vector<Figure> figures_;
};

nlohmann::json json_of(const std::vector<FigurePoint>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const FigurePoint& point : points) {
    nlohmann::json& json = list.emplace_back(nlohmann::json{{"x", io::number_to_json(point.x)},
                                                            {"y", io::number_to_json(point.y)},
                                                            {"label", point.label},
                                                            {"open", point.open}});
    if (!point.tip.empty()) json["tip"] = point.tip;
  }
  return list;
}

nlohmann::json json_of(const FigurePanel& panel) {
  nlohmann::json all = nlohmann::json::array();
  for (const FigureSeries& series : panel.series) {
    all.push_back({{"name", series.name},
                   {"role", series.role},
                   {"slot", series.slot},
                   {"points", json_of(series.points)}});
  }
  return {{"title", panel.title},
          {"caption", panel.caption},
          {"powers", panel.powers},
          {"series", std::move(all)},
          {"front", json_of(panel.front)}};
}

}  // namespace

std::string_view to_string(FigureForm form) {
  static constexpr std::array<std::string_view, 6> names{"points", "lines", "ridges",
                                                         "bars",   "marks", "shades"};
  return names.at(static_cast<std::size_t>(form));
}

std::vector<std::size_t> pareto_front(std::span<const FigurePoint> points) {
  const auto beats = [](const FigurePoint& a, const FigurePoint& b) {
    return a.x <= b.x && a.y <= b.y && (a.x < b.x || a.y < b.y);
  };
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto beats_it = [&](const FigurePoint& other) { return beats(other, points[i]); };
    if (std::ranges::none_of(points, beats_it)) front.push_back(i);
  }
  std::ranges::stable_sort(front, {}, [&](std::size_t i) { return points[i].x; });
  return front;
}

std::string_view released_filter_sentence() {
  return "tight_inclusion_released has the filter and the order of operations that the public "
         "Tight-Inclusion ships since January 2022: on each axis 30 (vertex-face) or 28 "
         "(edge-edge) "
         "times 2^-52 times min(x_max, 1)^3, where the paper has max(x_max, 1)^3. F is linear in "
         "the "
         "coordinates, so that this is too small where they are small or large. False negatives "
         "were "
         "seen on the public Tight-Inclusion itself (revision ca9a8c2), and on SCCD of 2026, which "
         "inherits the filter and calls its answers certified. Contacts at t=1 are exact by "
         "construction: a vertex of one primitive has the very coordinates of a vertex of the "
         "other.";
}

std::vector<Figure> figures_of(const Measurements& measurements) {
  return Builder(measurements).figures();
}

nlohmann::json to_json(const std::vector<Figure>& figures) {
  nlohmann::json list = nlohmann::json::array();
  for (const Figure& figure : figures) {
    nlohmann::json panels = nlohmann::json::array();
    for (const FigurePanel& panel : figure.panels) panels.push_back(json_of(panel));
    list.push_back({{"id", figure.id},
                    {"title", figure.title},
                    {"description", figure.description},
                    {"form", to_string(figure.form)},
                    {"x_label", figure.x_label},
                    {"y_label", figure.y_label},
                    {"x_log", figure.x_log},
                    {"x_even", figure.x_even},
                    {"y_log", figure.y_log},
                    {"panels", std::move(panels)}});
  }
  return list;
}

}  // namespace touchstone::verify::report

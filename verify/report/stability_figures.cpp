#include "verify/report/stability_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "verify/io/csv.hpp"

namespace touchstone::verify::report {
namespace {

using Count = std::uint64_t StabilityMark::*;

/// A count of a cell: its column of the data, and its words.
struct CountName {
  Count count;
  std::string_view column;
  std::string_view words;
};

constexpr std::array cell_counts{
    CountName{&StabilityMark::queries, "queries", "queries"},
    CountName{&StabilityMark::collisions, "collisions", "collisions"},
    CountName{&StabilityMark::false_positives, "false_positives", "false positives"},
    CountName{&StabilityMark::false_negatives, "false_negatives", "false negatives"},
    CountName{&StabilityMark::late_tois, "late_tois", "late times of impact"},
    CountName{&StabilityMark::early_upper_tois, "early_upper_tois", "early upper times of impact"},
    CountName{&StabilityMark::beyond_tolerance, "beyond_tolerance", "beyond the tolerance"},
    CountName{&StabilityMark::errors, "errors", "errors"},
    CountName{&StabilityMark::hangs, "hangs", "of them hangs"},
    CountName{&StabilityMark::undecided, "undecided", "undecided"},
};

/// The cell_counts in the order of a cell's text.
constexpr std::array in_text{&StabilityMark::false_negatives,  &StabilityMark::false_positives,
                             &StabilityMark::late_tois,        &StabilityMark::early_upper_tois,
                             &StabilityMark::beyond_tolerance, &StabilityMark::errors,
                             &StabilityMark::undecided,        &StabilityMark::hangs};

std::string row_of(const StabilityMark& mark) {
  return mark.kind == Kind::vertex_face ? "vf" : "ee";
}

/// The letter of the worst fault if there is one, and "!" where there are errors or hangs besides.
std::string mark_text(const StabilityMark& mark) {
  std::string text;
  if (mark.worst) text += judge::letter_of(*mark.worst, mark.is_slight);
  const bool is_error = mark.worst && judge::is_error(*mark.worst);
  if (mark.hangs != 0 || (mark.errors != 0 && !is_error)) text += '!';
  return text;
}

/// All numbers of a cell in words.
std::string tip_of(const StabilityMark& mark) {
  std::string text = fmt::format("{} queries, {} collisions", mark.queries, mark.collisions);
  for (const Count count : in_text) {
    if (mark.*count == 0) continue;
    const auto* const name = std::ranges::find(cell_counts, count, &CountName::count);
    text += fmt::format(", {} {}", mark.*count, name->words);
  }
  if (mark.toi_error) {
    text += fmt::format("\nerror of the time of impact: median {}, greatest {}",
                        short_number(mark.toi_error->median), short_number(mark.toi_error->max));
  }
  if (!std::isnan(mark.nanoseconds)) text += fmt::format("\n{:.0f} ns a query", mark.nanoseconds);
  if (!std::isnan(mark.checks)) text += fmt::format("\n{:.1f} checks a query", mark.checks);
  return text;
}

/// The panel of a mark's hardness, made where there is none.
FigurePanel& panel_of(Figure& figure, const StabilityMark& mark) {
  const auto found = std::ranges::find(figure.panels, mark.hardness, &FigurePanel::title);
  if (found != figure.panels.end()) return *found;
  return figure.panels.emplace_back(FigurePanel{.title = mark.hardness,
                                                .caption = mark.measure,
                                                .powers = mark.is_power,
                                                .series = {},
                                                .front = {}});
}

/// A number of a cell.
using Number = double (*)(const StabilityMark&);

class Maps {
 public:
  Maps(std::span<const StabilityMark> marks, const MethodSlots& slots)
      : marks_(marks), slots_(slots) {}

  [[nodiscard]] std::vector<Figure> figures() {
    add_worst();
    add_number("stability_toi_median", "Stability: the median error of the time of impact",
               "error of the time of impact, median", [](const StabilityMark& mark) {
                 return mark.toi_error ? mark.toi_error->median : Measurement::unknown;
               });
    add_number("stability_toi_max", "Stability: the greatest error of the time of impact",
               "error of the time of impact, greatest", [](const StabilityMark& mark) {
                 return mark.toi_error ? mark.toi_error->max : Measurement::unknown;
               });
    add_number("stability_time", "Stability: the time a query", "time a query, ns",
               [](const StabilityMark& mark) { return mark.nanoseconds; });
    add_number("stability_checks", "Stability: the checks a query", "checks a query",
               [](const StabilityMark& mark) { return mark.checks; });
    return std::move(figures_);
  }

 private:
  /// With the rows of a method side by side; nothing without rows.
  void add(Figure figure) {
    for (FigurePanel& panel : figure.panels) {
      std::ranges::stable_sort(panel.series, {}, &FigureSeries::slot);
    }
    if (!figure.panels.empty()) figures_.push_back(std::move(figure));
  }

  /// Draws a cell, and begins its row of the data.
  std::vector<std::string>& add_cell(Figure& figure, const StabilityMark& mark,
                                     FigurePoint point) const {
    series_of(panel_of(figure, mark), mark.method, row_of(mark), slots_.at(mark.method))
        .points.push_back(std::move(point));
    return figure.data.rows.emplace_back(
        std::vector<std::string>{mark.hardness, mark.measure, fmt::format("{}", mark.exponent),
                                 std::string(to_string(mark.kind)), mark.method});
  }

  void add_worst() {
    Figure figure{
        .id = "stability",
        .title = "Stability: what goes wrong as queries get harder",
        .description =
            "A cell a level of hardness: the worst that happens at it, and how often, in percent. "
            "N: false negatives, of the collisions. T: the time of impact excludes the true one, "
            "of the collisions. E: errors. B: a yes beyond its tolerance, of the misses. Shades: "
            "false positives, of the misses, the deeper the more. Pale and empty: every answer is "
            "right. !: errors or hangs besides. vf: vertex-face. ee: edge-edge.",
        .form = FigureForm::marks,
        .x_label = "level",
        .y_label = {},
        .x_log = false,
        .y_log = false,
        .panels = {},
        .data = {{}, {"hardness", "measure", "level", "kind", "method"}, {}}};
    for (const CountName& name : cell_counts) figure.data.columns.emplace_back(name.column);
    for (const char* const column : {"worst", "worst_rate", "ns_per_query"}) {
      figure.data.columns.emplace_back(column);
    }
    for (const StabilityMark& mark : marks_) {
      std::vector<std::string>& row =
          add_cell(figure, mark,
                   {static_cast<double>(mark.exponent), mark.worst_rate, mark_text(mark),
                    mark.worst == judge::Fault::false_negative, tip_of(mark)});
      for (const CountName& name : cell_counts)
        row.push_back(fmt::format("{}", mark.*(name.count)));
      row.emplace_back(mark.worst ? judge::to_text(*mark.worst) : "");
      row.push_back(fmt::format("{}", mark.worst_rate));
      row.push_back(io::csv_number(mark.nanoseconds));
    }
    add(std::move(figure));
  }

  /// A number of each cell, of the methods that give it.
  void add_number(const std::string& id, const std::string& title, const std::string& y_label,
                  Number value) {
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
    for (const StabilityMark& mark : marks_) {
      if (!std::isnan(value(mark))) giving.insert(mark.method);
    }
    for (const StabilityMark& mark : marks_) {
      if (!giving.contains(mark.method)) continue;
      const double number = value(mark);
      add_cell(figure, mark, {static_cast<double>(mark.exponent), number, {}, false})
          .push_back(io::csv_number(number));
    }
    add(std::move(figure));
  }

  std::span<const StabilityMark> marks_;
  const MethodSlots& slots_;
  std::vector<Figure> figures_;
};

}  // namespace

std::vector<Figure> stability_figures(std::span<const StabilityMark> marks,
                                      const MethodSlots& slots) {
  return Maps(marks, slots).figures();
}

}  // namespace touchstone::verify::report

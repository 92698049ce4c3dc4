#include "verify/stability/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/stability/svg.hpp"

namespace touchstone::verify {
namespace {

// Lengths are in units of the picture, about a pixel each.
constexpr double margin = 16.0;
constexpr double cell_width = 36.0;
constexpr double cell_height = 19.0;
constexpr double label_width = 104.0;
constexpr double gap = 24.0;
constexpr double panel_title = 40.0;
constexpr double panel_footer = 30.0;
constexpr std::size_t levels = std::tuple_size_v<decltype(Hardness::exponents)>;
constexpr std::size_t panels_abreast = 2;
constexpr double panel_width = label_width + cell_width * static_cast<double>(levels);
constexpr double width = 2.0 * margin + gap + 2.0 * panel_width;

constexpr std::string_view style =
    R"(text{font:13px "DejaVu Sans",system-ui,sans-serif;fill:#1b1f23}
.paper{fill:#ffffff}
.h1{font-size:22px;font-weight:bold}
.h2{font-size:18px;font-weight:bold}
.h3{font-size:14px;font-weight:bold}
.note{fill:#56616a}
.n{font-size:11px;text-anchor:middle}
.m{text-anchor:middle}
.r{font-size:11px;text-anchor:end}
.k{font-size:11px;fill:#56616a;text-anchor:middle}
.calm{fill:#e8eded}
.void{fill:none;stroke:#d4dbdb}
.p1{fill:#cfe3f2}.p2{fill:#92c1e4}.p3{fill:#4a97cf}.p4{fill:#0072b2}.p5{fill:#004c78}
.q0{fill:#f1eef5}.q1{fill:#ddd5e8}.q2{fill:#c0b2d5}.q3{fill:#9a86bb}.q4{fill:#745b9c}.q5{fill:#4c3575}
.fn{fill:#d55e00;stroke:#1b1f23;stroke-width:2}
.time{fill:#f0e442}.err{fill:#cc79a7}.tol{fill:#009e73}
text.on-light{fill:#1b1f23}
text.on-dark{fill:#ffffff}
text.on-fn{fill:#ffffff;font-weight:bold}
@media (prefers-color-scheme:dark){
text{fill:#e6eaec}.paper{fill:#14181b}.note,.k{fill:#a3afb7}
.calm{fill:#283034}.void{stroke:#3a4449}
.p1{fill:#17324a}.p2{fill:#1d4f78}.p3{fill:#2673ad}.p4{fill:#56a5dc}.p5{fill:#a6d4f5}
.q0{fill:#231d2e}.q1{fill:#382d4d}.q2{fill:#51416f}.q3{fill:#755f9d}.q4{fill:#a08bc6}.q5{fill:#d3c6ea}
.fn{stroke:#ffffff}
text.on-light{fill:#e6eaec}text.on-dark{fill:#14181b}text.always-dark{fill:#14181b}
}
)";

std::string superscript(int number) {
  static constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴",
                                                           "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) {
    text += digits.at(static_cast<std::size_t>(digit - '0'));
  }
  return text;
}

std::string percent(double rate) {
  const double value = 100.0 * rate;
  if (value > 0.0 && value < 1.0) return "<1%";
  return fmt::format("{:.0f}%", value > 99.0 && value < 100.0 ? 99.0 : value);
}

/// How a cell looks.
struct Look {
  std::string_view fill;
  std::string_view words;  // class of the text on it
  std::string text;
};

/// One of the steps from light to deep: the words on the deep ones are light.
Look shade(char scale, std::size_t step, std::size_t deep_from, std::string text) {
  static constexpr std::array<std::string_view, 6> p{"p1", "p1", "p2", "p3", "p4", "p5"};
  static constexpr std::array<std::string_view, 6> q{"q0", "q1", "q2", "q3", "q4", "q5"};
  return {.fill = (scale == 'p' ? p : q).at(step),
          .words = step >= deep_from ? "on-dark" : "on-light",
          .text = std::move(text)};
}

/// False positives: a tenth, a quarter, a half, and nearly all of the misses.
Look false_positive_look(double rate) {
  static constexpr std::array<double, 4> ends{0.1, 0.25, 0.5, 0.9};
  const auto step = static_cast<std::size_t>(
      1 + std::ranges::count_if(ends, [&](double end) { return rate > end; }));
  return shade('p', step, 3, percent(rate));
}

Look look_of(const Outcome& outcome) {
  if (!outcome.worst) return {.fill = "calm", .words = "on-light", .text = ""};
  switch (*outcome.worst) {
    case Fault::false_negative:
      return {.fill = "fn", .words = "on-fn", .text = percent(outcome.rate)};
    case Fault::late_toi:
    case Fault::early_toi_upper:
      return {.fill = "time", .words = "always-dark", .text = percent(outcome.rate)};
    case Fault::error:
      return {.fill = "err", .words = "always-dark", .text = percent(outcome.rate)};
    case Fault::beyond_tolerance:
      return {.fill = "tol", .words = "always-dark", .text = percent(outcome.rate)};
    default:
      return false_positive_look(outcome.rate);
  }
}

/// A number from the least to the greatest that make a difference, by factors.
struct Scale {
  double least;
  double greatest;
};

constexpr Scale error_scale{1e-15, 1.0};
constexpr Scale time_scale{30.0, 1e7};
constexpr Scale check_scale{1.0, 1e5};

std::size_t step_on(const Scale& scale, double number) {
  if (!(number > scale.least)) return 0;
  const double part = std::log(number / scale.least) / std::log(scale.greatest / scale.least);
  return static_cast<std::size_t>(std::clamp(1.0 + 5.0 * part, 1.0, 5.0));
}

/// A digit and a power of ten; the power alone where both do not fit.
std::string in_powers_of_ten(double number) {
  const double exponent = std::floor(std::log10(number));
  if (std::abs(exponent) >= 100.0) return "10" + superscript(static_cast<int>(exponent));
  return fmt::format("{:.0f}e{:.0f}", std::min(9.0, number / std::pow(10.0, exponent)), exponent);
}

/// Numbers from here on are rounded to four digits before the point.
constexpr double four_digits = 999.5;

/// In as few characters as fit into a cell.
std::string short_number(double number) {
  if (number == 0.0) return "0";
  if (std::isinf(number)) return "∞";
  if (number < 1e-2 || number >= four_digits * 1e6) return in_powers_of_ten(number);
  if (number < 10.0) return fmt::format("{:.2g}", number);
  if (number < four_digits) return fmt::format("{:.0f}", number);
  if (number < four_digits * 1e3) return fmt::format("{:.0f}k", number / 1e3);
  return fmt::format("{:.0f}M", number / 1e6);
}

std::string short_time(double nanoseconds) {
  if (nanoseconds < four_digits) return fmt::format("{:.0f}ns", nanoseconds);
  if (nanoseconds < four_digits * 1e3) return fmt::format("{:.0f}µs", nanoseconds / 1e3);
  constexpr double three_digits = 99.5;  // of the wide "ms" no more fit
  if (nanoseconds < three_digits * 1e6) return fmt::format("{:.0f}ms", nanoseconds / 1e6);
  return short_number(nanoseconds / 1e9) + "s";
}

Look number_look(const Scale& scale, const std::optional<double>& number,
                 std::string (*to_words)(double)) {
  if (!number || std::isnan(*number)) return {.fill = "void", .words = "note", .text = ""};
  return shade('q', step_on(scale, *number), 3, to_words(*number));
}

/// What the rows of a panel show of a cell, for each kind a row.
struct Measure {
  std::string_view name;
  Look (*look)(const StabilityCell& cell, std::size_t method);
};

const MethodResult& of(const StabilityCell& cell, std::size_t method) {
  return cell.judged.methods.at(method);
}

Look outcome_look(const StabilityCell& cell, std::size_t method) {
  return look_of(outcome_of(cell.judged, method));
}

Look median_look(const StabilityCell& cell, std::size_t method) {
  return number_look(error_scale, of(cell, method).judgement.toi_errors.quantile(0.5),
                     short_number);
}

Look greatest_look(const StabilityCell& cell, std::size_t method) {
  return number_look(error_scale, of(cell, method).judgement.toi_errors.max(), short_number);
}

Look time_look(const StabilityCell& cell, std::size_t method) {
  return number_look(time_scale, nanoseconds_per_query(of(cell, method)), short_time);
}

Look check_look(const StabilityCell& cell, std::size_t method) {
  return number_look(check_scale, checks_per_query(of(cell, method)), short_number);
}

constexpr std::array<Measure, 5> measures{{{"wrong", outcome_look},
                                           {"toi error p50", median_look},
                                           {"toi error max", greatest_look},
                                           {"time/query", time_look},
                                           {"checks/query", check_look}}};

/// All there is to say of a cell.
std::string description_of(const StabilityCell& cell, std::size_t method) {
  const MethodResult& result = of(cell, method);
  const Judgement& judged = result.judgement;
  std::string text = fmt::format(
      "{}: {} {}, {}\n{} queries, {} collisions\n{} false negatives, {} false positives, {} late "
      "toi, {} early upper toi, {} beyond tolerance, {} errors, {} undecided",
      result.name, cell.hardness->name, power_text(cell.exponent), to_string(cell.kind),
      judged.queries, cell.judged.collisions, judged.count(Fault::false_negative),
      judged.count(Fault::false_positive), judged.count(Fault::late_toi),
      judged.count(Fault::early_toi_upper), judged.count(Fault::beyond_tolerance),
      judged.count(Fault::error), judged.undecided);
  if (judged.toi_errors.count() != 0) {
    text += fmt::format("\ntoi error: median {:.2e}, greatest {:.2e}",
                        judged.toi_errors.quantile(0.5), judged.toi_errors.max());
  }
  if (const auto time = nanoseconds_per_query(result))
    text += fmt::format("\n{:.0f} ns/query", *time);
  if (const auto checks = checks_per_query(result)) {
    text += fmt::format("\n{:.1f} checks/query", *checks);
  }
  return text;
}

/// Draws the picture from top to bottom.
class Drawing {
 public:
  explicit Drawing(const StabilityResult& result)
      : result_(result), picture_(width, height_of(result), "Stability of methods", style) {
    for (const StabilityCell& cell : result.cells) panels_[cell.hardness].push_back(&cell);
    for (const StabilityCell& cell : result.cells) {
      if (order_.empty() || order_.back() != cell.hardness) order_.push_back(cell.hardness);
    }
  }

  std::string draw() {
    picture_.add_rectangle({0, 0, width, height_of(result_)}, "paper");
    draw_heading();
    draw_legend();
    draw_overview();
    for (std::size_t i = 0; i < result_.total.methods.size(); ++i) draw_method(i);
    return picture_.finish();
  }

 private:
  static constexpr double heading_height = 64.0;
  static constexpr double legend_height = 92.0;
  static constexpr double overview_row = 34.0;
  static constexpr double method_title = 40.0;

  static std::size_t hardness_count(const StabilityResult& result) {
    std::size_t count = 0;
    const Hardness* latest = nullptr;
    for (const StabilityCell& cell : result.cells) {
      count += cell.hardness != latest ? 1U : 0U;
      latest = cell.hardness;
    }
    return count;
  }

  /// Rows of measures that a method has.
  static std::size_t measure_count(const StabilityResult& result, std::size_t method) {
    const bool counts = checks_per_query(result.total.methods.at(method)).has_value();
    return counts ? measures.size() : measures.size() - 1;
  }

  static double panel_height(const StabilityResult& result, std::size_t method) {
    return panel_title + panel_footer +
           2.0 * cell_height * static_cast<double>(measure_count(result, method));
  }

  static double method_height(const StabilityResult& result, std::size_t method) {
    const std::size_t lines = (hardness_count(result) + panels_abreast - 1) / panels_abreast;
    return method_title + static_cast<double>(lines) * panel_height(result, method);
  }

  static double height_of(const StabilityResult& result) {
    double height = margin + heading_height + legend_height + 2.0 * overview_row +
                    overview_row * static_cast<double>(result.total.methods.size());
    for (std::size_t i = 0; i < result.total.methods.size(); ++i)
      height += method_height(result, i);
    return height + margin;
  }

  void draw_heading() {
    picture_.add_text(margin, y_ + 22, "h1", "Stability: what goes wrong as queries get harder");
    std::string about = fmt::format("{} queries a cell, half of them collisions; seed {}",
                                    result_.count, result_.seed);
    if (!is_contact(result_.separation)) about += "; separation " + to_text(result_.separation);
    if (result_.total.interrupted) about += "; interrupted: not all is here";
    if (result_.cells.empty()) about = "no cells were judged";
    picture_.add_text(margin, y_ + 46, "note", about);
    y_ += heading_height;
  }

  /// A sample with its meaning; returns where the next one may begin.
  double draw_sample(double x, double y, const Look& look, std::string_view meaning) {
    draw_cell({x, y, cell_width - 2, cell_height - 2}, look, "n");
    picture_.add_text(x + cell_width + 2, y + 13, "l", meaning);
    return x + cell_width + 16 + 7.2 * static_cast<double>(meaning.size());
  }

  void draw_legend() {
    const auto outcome = [](std::optional<Fault> worst, double rate) {
      return look_of({.worst = worst, .rate = rate});
    };
    double x = draw_sample(margin, y_, outcome(std::nullopt, 0), "nothing wrong");
    x = draw_sample(x, y_, outcome(Fault::false_negative, 0.05), "false negatives, of collisions");
    x = draw_sample(x, y_, outcome(Fault::late_toi, 0.05), "toi excludes the true one");
    draw_sample(x, y_, outcome(Fault::error, 0.05), "errors");
    y_ += cell_height + 5;
    x = draw_sample(margin, y_, outcome(Fault::beyond_tolerance, 0.05), "beyond its tolerance");
    for (const double rate : {0.05, 0.2, 0.4, 0.8}) {
      x = draw_sample(x, y_, outcome(Fault::false_positive, rate), "") - 16;
    }
    draw_sample(x, y_, outcome(Fault::false_positive, 1.0), "false positives, of misses");
    y_ += cell_height + 5;
    picture_.add_text(margin, y_ + 13, "note",
                      "toi error: how far toi_lower is from the exact time of impact, in units of "
                      "the motion's duration (t from 0 to 1).");
    y_ += legend_height - 2 * (cell_height + 5);
  }

  void draw_cell(const SvgBox& box, const Look& look, std::string_view size) {
    picture_.add_rectangle(box, look.fill);
    if (look.text.empty()) return;
    picture_.add_text(box.x + box.width / 2, box.y + box.height / 2 + 4,
                      fmt::format("{} {}", size, look.words), look.text);
  }

  /// The worst outcome at any level and kind.
  [[nodiscard]] Outcome worst_of(const Hardness* hardness, std::size_t method) const {
    CertifyResult sum;
    for (const StabilityCell* cell : panels_.at(hardness)) sum += cell->judged;
    return outcome_of(sum, method);
  }

  void draw_overview() {
    const double column = (width - 2 * margin - 2 * label_width) /
                          static_cast<double>(std::max<std::size_t>(order_.size(), 1));
    const double left = margin + 2 * label_width;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      picture_.add_text(left + column * (static_cast<double>(i) + 0.5), y_ + 20, "h3 m",
                        order_[i]->name);
    }
    y_ += overview_row;
    for (std::size_t method = 0; method < result_.total.methods.size(); ++method) {
      picture_.add_text(margin, y_ + 20, "h3", result_.total.methods[method].name);
      for (std::size_t i = 0; i < order_.size(); ++i) {
        Look look = look_of(worst_of(order_[i], method));
        if (look.text.empty()) look.text = "0";
        draw_cell({left + column * static_cast<double>(i), y_, column - 3, overview_row - 3}, look,
                  "m");
      }
      y_ += overview_row;
    }
    y_ += overview_row;
  }

  void draw_method(std::size_t method) {
    const MethodResult& total = result_.total.methods[method];
    const std::string verdict =
        fmt::format("{} — promises: {}; {}", total.name, to_string(total.promise),
                    keeps(total.judgement, total.promise) ? "kept" : "BROKEN");
    picture_.add_text(margin, y_ + 18, "h2", verdict);
    y_ += method_title;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const bool is_left = i % panels_abreast == 0;
      draw_panel(is_left ? margin : margin + panel_width + gap, order_[i], method);
      if (!is_left || i + 1 == order_.size()) y_ += panel_height(result_, method);
    }
  }

  void draw_panel(double x, const Hardness* hardness, std::size_t method) {
    picture_.add_text(x, y_ + 12, "h3", hardness->name);
    picture_.add_text(x, y_ + 29, "note", hardness->measure);
    const std::size_t rows = measure_count(result_, method);
    const double top = y_ + panel_title;
    for (std::size_t row = 0; row < rows; ++row) {
      const double y = top + 2.0 * cell_height * static_cast<double>(row);
      picture_.add_text(x + label_width - 26, y + cell_height + 4, "r", measures.at(row).name);
      picture_.add_text(x + label_width - 6, y + 13, "r", "vf");
      picture_.add_text(x + label_width - 6, y + cell_height + 13, "r", "ee");
    }
    const double bottom = top + 2.0 * cell_height * static_cast<double>(rows);
    for (std::size_t level = 0; level < levels; ++level) {
      const double column = x + label_width + cell_width * (static_cast<double>(level) + 0.5);
      picture_.add_text(column - 1, bottom + 13, "k", power_text(hardness->exponents.at(level)));
    }
    for (const StabilityCell* cell : panels_.at(hardness)) draw_column(x, top, *cell, method);
  }

  /// The cells of all measures of one level and kind.
  void draw_column(double x, double top, const StabilityCell& cell, std::size_t method) {
    const auto& exponents = cell.hardness->exponents;
    const auto level = std::ranges::find(exponents, cell.exponent) - exponents.begin();
    picture_.begin_group(description_of(cell, method));
    for (std::size_t row = 0; row < measure_count(result_, method); ++row) {
      const double kind = cell.kind == Kind::vertex_face ? 0.0 : 1.0;
      const double y = top + cell_height * (2.0 * static_cast<double>(row) + kind);
      draw_cell({x + label_width + cell_width * static_cast<double>(level), y, cell_width - 2,
                 cell_height - 2},
                measures.at(row).look(cell, method), "n");
    }
    picture_.end_group();
  }

  const StabilityResult& result_;
  SvgPicture picture_;
  std::map<const Hardness*, std::vector<const StabilityCell*>> panels_;
  std::vector<const Hardness*> order_;
  double y_ = margin;
};

}  // namespace

std::string power_text(int exponent) { return "2" + superscript(exponent); }

std::string heat_map(const StabilityResult& result) { return Drawing(result).draw(); }

}  // namespace touchstone::verify

#include "verify/report/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "verify/io/printable.hpp"
#include "verify/report/figures.hpp"
#include "verify/report/tables.hpp"

namespace touchstone::verify::report {
namespace {

/// A method and why what we measure of it is not what was published.
struct Difference {
  std::string_view method;
  std::string_view reason;
};

constexpr auto differences = std::to_array<Difference>({
    {"irf",
     "Ours tests the same boxes, but stops at 100,000 checks a query and then says yes; what "
     "reaches "
     "the limit stands in the table."},
    {"uirf",
     "Limited to 100,000 checks too. Where motion is in a plane its cubic vanishes everywhere, so "
     "that it searches the whole interval down to δ: these queries reach the limit."},
    {"fprf",
     "The published table 1 has η = 0, and so has ours. Then every root is double, and a contact "
     "is "
     "found only if rounding splits it the right way; which contacts are lost depends on the last "
     "bits "
     "of the root finder, so the counts of two implementations differ."},
    {"tccd",
     "Accepts every motion in a common plane, and every relative translation that crosses in the "
     "middle third of the step. The public handcrafted sample has a larger share of these than all "
     "of the data."},
    {"rp",
     "Misses contacts with an even number of roots. The public handcrafted sample holds fewer of "
     "them than the whole, so no miss here is no disagreement."},
    {"rrp",
     "As RP; besides, it misses what collides while nothing moves relative to it, and contacts "
     "with "
     "a "
     "triangle that is degenerate at t = 0 or t = 1."},
    {"bsc",
     "Says yes at every inflection of the cubic, and misses contact in a common plane, where all "
     "coefficients vanish; the published code does both."},
    {"msrf",
     "Without a separation asked for it runs with h = 1e-8, as the published wrapper does. The "
     "published table 1 mixes two settings: its numbers on simulations are those of d = 1e-8 in "
     "table "
     "2, those on the handcrafted data nearly those of d = 1e-100."},
    {"tight_inclusion",
     "Runs with our derived filter, which is narrower than the published one "
     "(`tight_inclusion_published`), and vectorised. On the handcrafted data the few queries that "
     "reach its limit of checks make its mean time."},
});

/// tests/fast/tight_inclusion_test.cpp asks it.
constexpr std::string_view plainest_miss =
    "The plainest of them: a vertex flies along the x axis from (-0.01, 0, 0) to (0.02, 0, 0), "
    "onto "
    "the resting triangle (0.02, -0.01, -0.01), (0.02, 0.02, -0.01), (0.02, -0.01, 0.02). They "
    "touch "
    "at t = 1. (0.02 + 0.01) - 0.01 is 3.5e-18 below 0.02, the filter is 5.3e-20, and the answer "
    "is "
    "no.\n";

/// The last part of an absolute path, without a slash at its end.
std::string last_part(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  return path.size() == 1 ? "/" : std::string(path.substr(path.rfind('/') + 1));
}

/// A command line, its words quoted as a shell takes them, with the last parts alone of absolute
/// paths: the folders of the machine that measured are of no use to a reader.
std::string without_folders(std::string_view command) {
  std::string result;
  bool quoted = false, word_begins = true;
  while (!command.empty()) {
    std::size_t length = 1;
    if (word_begins && command.front() == '/') {
      length = std::min(command.find_first_of(quoted ? "'" : " '"), command.size());
      result += last_part(command.substr(0, length));
      word_begins = false;
    } else {
      const char c = command.front();
      if (c == '\'') quoted = !quoted;
      word_begins = c == '\'' || c == '=' || (c == ' ' && !quoted);
      result += c;
    }
    command.remove_prefix(length);
  }
  return result;
}

class Writer {
 public:
  explicit Writer(const Measurements& measurements)
      : measurements_(with_printable_texts(measurements)) {}

  [[nodiscard]] std::string document() {
    text_ = "# Results\n\n";
    text_ += fmt::format(
        "Written by `./run results`; not edited by hand. Made{} by\n\n```\n{}\n```\n\n",
        io::markdown_escaped(origin_text(measurements_)), without_folders(measurements_.command));
    if (measurements_.interrupted) text_ += "**Interrupted: not all is here.**\n\n";
    text_ +=
        "The truth is the exact oracle's. Published: Wang et al. 2021, \"A Large Scale Benchmark "
        "and an Inclusion-Based Algorithm for Continuous Collision Detection\", on another "
        "machine.\n\n";
    write_sentences();
    write_tables("Table 1: all methods", field_tables(measurements_));
    write_tables("Table 2: MSRF over the minimum separation d",
                 separation_tables(measurements_, "msrf"));
    write_tables("Table 3: FPRF over the minimum separation d",
                 separation_tables(measurements_, "fprf"));
    write_filters();
    write_meanings();
    write_differences();
    return std::move(text_);
  }

 private:
  using Test = std::function<bool(const Measurement&)>;

  [[nodiscard]] std::string names_where(std::string_view place, const Test& test) const {
    std::string names;
    for (const Measurement* m : of_experiment(measurements_, Experiment::field)) {
      if (fmt::format("{}, {}", m->group, to_string(m->kind)) != place || !test(*m)) continue;
      names += (names.empty() ? "" : ", ") + io::markdown_code(m->method);
    }
    return names.empty() ? "none" : names;
  }

  /// The findings, a line a group and kind.
  void write_sentences() {
    text_ += "## In sentences\n\n";
    for (const Table& table : field_tables(measurements_)) {
      text_ += fmt::format("- **{}**: ", io::markdown_escaped(table.title));
      text_ += fmt::format(
          "with false negatives: {}. Without false positives: {}. ",
          names_where(table.title, [](const Measurement& m) { return m.false_negatives != 0; }),
          names_where(table.title, [](const Measurement& m) { return m.false_positives == 0; }));
      text_ += fmt::format("Faster than `certified` on the same queries: {}.\n",
                           names_where(table.title, [](const Measurement& m) {
                             return m.method != fast::certified_info().name &&
                                    m.nanoseconds < m.certified_nanoseconds;
                           }));
    }
    text_ += "\n";
    write_fronts();
    text_ += "\n";
  }

  /// Which methods are on the Pareto fronts: a sentence if they are the same everywhere.
  void write_fronts() {
    std::map<std::string, std::vector<std::string>> comparisons;
    for (const Figure& figure : figures_of(measurements_)) {
      if (figure.form != FigureForm::points) continue;
      const std::string what = figure.y_label.substr(0, figure.y_label.find(", of the"));
      for (const FigurePanel& panel : figure.panels) {
        std::string names;
        for (const FigurePoint& point : panel.front) {
          names += (names.empty() ? "" : ", ") + io::markdown_escaped(point.label);
        }
        comparisons[names.empty() ? "none" : names].push_back(
            fmt::format("{} ({})", what, io::markdown_escaped(panel.title)));
      }
    }
    if (comparisons.empty()) return;
    text_ +=
        "On the Pareto front of time against false positives and of time against the error of the "
        "time of impact, of those without a miss: ";
    if (comparisons.size() == 1) {
      const auto& [names, places] = *comparisons.begin();
      text_ += fmt::format("{}, in all {} comparisons.\n", names, places.size());
      return;
    }
    text_ += "\n\n";
    for (const auto& [names, places] : comparisons) {
      text_ += fmt::format("- {}: {}\n", names, fmt::join(places, "; "));
    }
  }

  void write_tables(std::string_view title, const std::vector<Table>& tables) {
    if (tables.empty()) return;
    text_ += fmt::format("## {}\n\n", title);
    write_subsections(tables);
  }

  void write_subsections(const std::vector<Table>& tables) {
    for (const Table& table : tables) {
      text_ += fmt::format("### {}\n\n{}\n", io::markdown_escaped(table.title), to_markdown(table));
    }
  }

  void write_filters() {
    const std::vector<Table> tables = filter_tables(measurements_);
    if (tables.empty()) return;
    text_ += fmt::format("## What Tight-Inclusion misses with each filter\n\n{}\n\n{}\n",
                         filter_sentence(), plainest_miss);
    write_subsections(tables);
  }

  void write_meanings() {
    text_ += "## The columns\n\n";
    for (const std::string& meaning : column_meanings()) text_ += fmt::format("- {}\n", meaning);
    text_ += "\n";
  }

  void write_differences() {
    std::set<std::string> measured;
    for (const Measurement& m : measurements_.all) measured.insert(m.method);
    text_ +=
        "## Why the numbers differ from the published ones\n\n"
        "- The data: of the published sets of 60 million queries a sample is public. Its "
        "simulation part here is the pairs of two steps "
        "that a conservative solver called colliding, so nearly all of them collide; the published "
        "sets are all candidates. Rates and mean times over them are not comparable, and slow "
        "methods look slower here: colliding pairs are the dear ones. The group `own-simulation` "
        "holds "
        "all "
        "candidates of the four scenes as `./run simulate` makes them: other meshes, materials and "
        "steps than the published ones.\n"
        "- The machine, and the time: ours is that of a query among many in one call, the "
        "published "
        "one that of single calls.\n"
        "- The separation: the published tables 2 and 3 judge all methods by one truth a distance; "
        "here "
        "each is judged in the norm that it measures in.\n";
    for (const auto& [method, reason] : differences) {
      if (measured.contains(std::string(method))) {
        text_ += fmt::format("- `{}`: {}\n", method, reason);
      }
    }
  }

  Measurements measurements_;
  std::string text_;
};

}  // namespace

std::string results_document(const Measurements& measurements) {
  return Writer(measurements).document();
}

}  // namespace touchstone::verify::report

#include "verify/report/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/printable.hpp"
#include "verify/report/published.hpp"

namespace touchstone::verify::report {
namespace {

using Texts = std::vector<std::string>;
using Chosen = std::vector<const Measurement*>;

constexpr const char* none = "–";
/// The separations of the published tables, in their order.
constexpr std::array<double, 5> published_distances{1e-2, 1e-8, 1e-16, 1e-30, 1e-100};

struct Meaning {
  std::string_view column;
  std::string_view text;
};

constexpr auto meanings = std::to_array<Meaning>({
    {"µs",
     "processor time a query, all queries in one call, one thread, median of the repetitions of "
     "one "
     "run in which the methods take turns."},
    {"÷ certified",
     "the same as a multiple of the certified solver's time on the same queries in the same run."},
    {"FN, FP",
     "false negatives (collisions that it missed) and false positives (with their share of the "
     "queries that do not collide)."},
    {"late", "times of impact above the exact one, and by how much of the step at most."},
    {"asked",
     "queries that the method was asked; where they are not all, an evenly spread sample, as large "
     "as the time allowed. Nothing is extrapolated. A method with * was asked fewer than the "
     "others of its table: compare shares, not counts."},
    {"collide", "of those asked, by the oracle, for the separation and norm of the row."},
    {"at limit",
     "queries that the method gave up at its limit of checks (1,000,000; IRF and UIRF 100,000) and "
     "called a collision."},
    {"toi error",
     "from the time that the method gives to the exact time of impact, in units of the motion's "
     "duration; – where it gives none."},
    {"published", "as printed, for the whole of the published data, on another machine."},
});

/// A group of queries, as tables and figures name it.
using Place = std::pair<std::string, Kind>;

std::vector<Place> places_of(const Chosen& measurements) {
  std::vector<Place> places;
  for (const Measurement* m : measurements) {
    const Place place{m->group, m->kind};
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  }
  return places;
}

std::string microseconds(double nanoseconds) { return short_number(nanoseconds / 1000.0); }

std::string asked_text(const Measurement& m) {
  return m.asked == m.group_queries ? fmt::format("{}", m.asked)
                                    : fmt::format("{} of {}", m.asked, m.group_queries);
}

void append(Texts& row, std::initializer_list<std::string> texts) {
  row.insert(row.end(), texts.begin(), texts.end());
}

void append_published(Texts& row, const std::optional<PublishedNumbers>& numbers) {
  if (!numbers) return append(row, {none, none, none});
  append(row, {std::string(numbers->microseconds), std::string(numbers->false_positives),
               std::string(numbers->false_negatives)});
}

void append_published_columns(Texts& columns, const Place& place) {
  const std::string_view size = published_size(place.first, place.second);
  if (size.empty()) return;
  append(columns, {fmt::format("published ({}) µs", size), "published FP", "published FN"});
}

/// "8 (10 %)".
std::string counted_share(std::uint64_t count, double share) {
  return count == 0 ? "0" : fmt::format("{} ({})", count, percent(share));
}

/// "12, ≤ 0.3": how many, and by how much of the step at most, where that is known.
std::string late_text(const Measurement& m) {
  if (m.late.count == 0) return fmt::format("{}", m.late_tois);
  return fmt::format("{}, ≤ {}", m.late.count, short_number(m.late.greatest.step));
}

void append_ours(Texts& row, const Measurement& m) {
  append(row,
         {fmt::format("{}", m.false_negatives),
          counted_share(m.false_positives, false_positive_rate(m)), microseconds(m.nanoseconds),
          short_number(m.nanoseconds / m.certified_nanoseconds), late_text(m), asked_text(m),
          fmt::format("{}", m.collisions), fmt::format("{}", m.at_limit)});
}

const Texts& columns_of_ours() {
  static const Texts columns{"FN",   "FP",    "µs",      "÷ certified",
                             "late", "asked", "collide", "at limit"};
  return columns;
}

/// The most queries that a method of a place was asked.
std::uint64_t most_asked(const Chosen& measurements, const Place& place) {
  std::uint64_t most = 0;
  for (const Measurement* m : measurements) {
    if (Place(m->group, m->kind) == place) most = std::max(most, m->asked);
  }
  return most;
}

Table field_table(const Chosen& measurements, const Place& place) {
  Table table;
  table.title = fmt::format("{}, {}", place.first, to_string(place.second));
  table.columns = {"method"};
  std::ranges::copy(columns_of_ours(), std::back_inserter(table.columns));
  append(table.columns, {"toi error, median", "toi error, max"});
  append_published_columns(table.columns, place);
  const bool is_published = !published_size(place.first, place.second).empty();
  const std::uint64_t most = most_asked(measurements, place);
  for (const Measurement* m : measurements) {
    if (Place(m->group, m->kind) != place) continue;
    Texts& row = table.rows.emplace_back();
    row.push_back(m->method + (m->asked < most ? "*" : ""));
    append_ours(row, *m);
    append(row, {m->toi_error ? short_number(m->toi_error->median) : none,
                 m->toi_error ? short_number(m->toi_error->max) : none});
    if (is_published) append_published(row, published_field(place.first, place.second, m->method));
  }
  return table;
}

/// The measurements of a separation table's row group, in its order.
Chosen at_distance(const Chosen& measurements, const Place& place, std::string_view method,
                   double distance) {
  static constexpr std::string_view inclusion = "tight_inclusion";
  std::vector<std::string_view> rows{method};
  if (method != inclusion) rows.push_back(inclusion);
  rows.push_back(fast::certified_info().name);
  Chosen chosen;
  for (const std::string_view wanted : rows) {
    for (const Measurement* m : measurements) {
      if (Place(m->group, m->kind) == place && m->method == wanted &&
          m->separation.distance == distance) {
        chosen.push_back(m);
      }
    }
  }
  return chosen;
}

Table separation_table(const Chosen& measurements, const Place& place, std::string_view method) {
  Table table;
  table.title = fmt::format("{}, {}", place.first, to_string(place.second));
  table.columns = {"d", "method", "norm"};
  std::ranges::copy(columns_of_ours(), std::back_inserter(table.columns));
  append_published_columns(table.columns, place);
  const bool is_published = !published_size(place.first, place.second).empty();
  for (const double distance : published_distances) {
    for (const Measurement* m : at_distance(measurements, place, method, distance)) {
      Texts& row = table.rows.emplace_back();
      append(row, {fmt::format("{:.0e}", distance), m->method,
                   m->separation.norm == Norm::linf ? "L∞" : "L2"});
      append_ours(row, *m);
      if (is_published) {
        append_published(row, published_separation(place.first, place.second, m->method, distance));
      }
    }
  }
  return table;
}

/// Measurements on the same queries, group by group.
std::vector<Chosen> side_by_side(const Chosen& measurements) {
  std::vector<Chosen> result;
  for (const Measurement* m : measurements) {
    const auto is_alike = [&](const Chosen& some) {
      const Measurement& other = *some.front();
      return other.group == m->group && other.kind == m->kind && other.scale == m->scale;
    };
    const auto found = std::ranges::find_if(result, is_alike);
    (found == result.end() ? result.emplace_back() : *found).push_back(m);
  }
  return result;
}

/// A row of what each misses; the columns are named by the first.
void append_misses(Table& table, Texts row, const Chosen& asked_alike) {
  if (table.rows.empty()) {
    table.columns.emplace_back("collide");
    for (const Measurement* m : asked_alike) table.columns.push_back(m->method + " FN");
  }
  row.push_back(fmt::format("{}", asked_alike.front()->collisions));
  for (const Measurement* m : asked_alike) {
    row.push_back(counted_share(m->false_negatives, false_negative_rate(*m)));
  }
  table.rows.push_back(std::move(row));
}

}  // namespace

std::vector<std::string> column_meanings() {
  std::vector<std::string> texts;
  texts.reserve(meanings.size());
  for (const auto& [column, meaning] : meanings) {
    texts.push_back(fmt::format("{}: {}", column, meaning));
  }
  return texts;
}

std::vector<Table> field_tables(const Measurements& measurements) {
  const Chosen chosen = of_experiment(measurements, Experiment::field);
  std::vector<Table> tables;
  for (const Place& place : places_of(chosen)) tables.push_back(field_table(chosen, place));
  return tables;
}

std::vector<Table> separation_tables(const Measurements& measurements, std::string_view method) {
  const Chosen chosen = of_experiment(measurements, Experiment::separation);
  Chosen of_method;
  std::ranges::copy_if(chosen, std::back_inserter(of_method),
                       [&](const Measurement* m) { return m->method == method; });
  std::vector<Table> tables;
  for (const Place& place : places_of(of_method)) {
    tables.push_back(separation_table(chosen, place, method));
  }
  return tables;
}

std::vector<Table> filter_tables(const Measurements& measurements) {
  const Chosen chosen = of_experiment(measurements, Experiment::filter);
  Table of_families{.title = "built-in families", .columns = {"family", "kind"}, .rows = {}};
  std::vector<Table> tables;
  for (const Chosen& asked_alike : side_by_side(chosen)) {
    const Measurement& first = *asked_alike.front();
    const std::string kind(to_string(first.kind));
    if (!first.scale) {
      const auto misses = [](const Measurement* m) { return m->false_negatives != 0; };
      if (std::ranges::any_of(asked_alike, misses)) {
        append_misses(of_families, {first.group, kind}, asked_alike);
      }
      continue;
    }
    auto table = std::ranges::find(tables, first.group, &Table::title);
    if (table == tables.end()) {
      tables.push_back({.title = first.group, .columns = {"scale", "kind"}, .rows = {}});
      table = std::prev(tables.end());
    }
    append_misses(*table, {fmt::format("{}", *first.scale), kind}, asked_alike);
  }
  if (!of_families.rows.empty()) tables.push_back(std::move(of_families));
  return tables;
}

std::string_view filter_sentence() {
  return "tight_inclusion_released has min(x_max, 1)^3 in its filter where the paper has "
         "max(x_max, 1)^3, each times 2^-52 and 30 (vertex-face) or 28 (edge-edge). F is linear in "
         "the coordinates, so that this is too small where they are small or large. "
         "docs/methods.md says where this filter is from, docs/benchmarks.md where it was seen to "
         "miss contacts. Contacts at t=1 are exact by construction: a vertex of one primitive has "
         "the very coordinates of a vertex of the other.";
}

std::string short_number(double value) {
  if (std::isnan(value)) return none;
  if (std::abs(value) >= 1000.0 && std::abs(value) < 1e9) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string percent(double share) {
  const double percents = 100.0 * share;
  // Of two digits, 100 would be 1e+02.
  return percents < 99.5 ? fmt::format("{:.2g} %", percents) : fmt::format("{:.0f} %", percents);
}

std::string to_markdown(const Table& table) {
  const auto line = [](const Texts& texts) {
    std::string result = "|";
    for (const std::string& text : texts) {
      result += ' ';
      result += io::markdown_escaped(text) + " |";
    }
    return result + "\n";
  };
  std::string text = line(table.columns);
  text += line(Texts(table.columns.size(), "---"));
  for (const Texts& row : table.rows) text += line(row);
  return text;
}

std::string to_csv(const Table& table) {
  static constexpr std::string_view line_end = "\r\n";
  std::string text = io::csv_row(table.columns, line_end);
  for (const Texts& row : table.rows) text += io::csv_row(row, line_end);
  return text;
}

}  // namespace touchstone::verify::report

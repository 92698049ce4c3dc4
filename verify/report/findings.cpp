#include "verify/report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "verify/report/tables.hpp"

namespace touchstone::verify::report {
namespace {

/// The least and the greatest of some numbers.
struct Range {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double number) {
    if (std::isnan(number)) return;
    least = std::min(least, number);
    greatest = std::max(greatest, number);
  }
  [[nodiscard]] bool is_empty() const { return least > greatest; }
  /// "3 to 12", "3" where both ends are the same in short.
  [[nodiscard]] std::string text() const {
    const std::string from = short_number(least), to = short_number(greatest);
    return from == to ? from : from + " to " + to;
  }
};

/// A method's measurements of the field together.
struct Sum {
  std::string method;
  std::uint64_t asked = 0;
  std::uint64_t missed = 0;  ///< false negatives and late times of impact
  std::uint64_t wrong = 0;   ///< these, and all else that is wrong
  Range nanoseconds = {};
  Range ratio = {};  ///< of its time to the certified solver's
};

/// In the order of the measurements.
std::vector<Sum> sums_of(const Measurements& measurements) {
  std::vector<Sum> sums;
  for (const Measurement* m : of_experiment(measurements, Experiment::field)) {
    auto sum = std::ranges::find(sums, m->method, &Sum::method);
    if (sum == sums.end()) sum = sums.insert(sum, {.method = m->method});
    const std::uint64_t missed = m->false_negatives + m->late_tois;
    sum->asked += m->asked;
    sum->missed += missed;
    sum->wrong += missed + m->early_upper_tois + m->false_positives + m->errors;
    sum->nanoseconds.add(m->nanoseconds);
    sum->ratio.add(m->nanoseconds / m->certified_nanoseconds);
  }
  return sums;
}

/// The descriptions of the listed items, separated by commas; items that are not in the list are
/// left out.
template <class List, class Say>
std::string list(const List& all, const Say& say) {
  std::string text;
  for (const auto& one : all) {
    const std::string said = say(one);
    if (!said.empty()) text += (text.empty() ? "" : ", ") + said;
  }
  return text.empty() ? "none" : text;
}

std::string queries_sentence(const Measurements& measurements, std::size_t methods) {
  std::map<std::pair<std::string, Kind>, std::pair<std::uint64_t, std::uint64_t>> groups;
  for (const Measurement* m : of_experiment(measurements, Experiment::field)) {
    auto& most = groups[{m->group, m->kind}];
    most = std::max(most, {m->asked, m->collisions});
  }
  std::uint64_t asked = 0, collisions = 0;
  for (const auto& [group, counts] : groups) {
    asked += counts.first;
    collisions += counts.second;
  }
  return fmt::format("{} methods were asked up to {} queries, {} of which collide.", methods, asked,
                     collisions);
}

std::string misses_sentence(const std::vector<Sum>& sums) {
  return fmt::format("No missed collision and no time of impact after the exact one: {}. Some: {}.",
                     list(sums, [](const Sum& sum) { return sum.missed == 0 ? sum.method : ""; }),
                     list(sums, [](const Sum& sum) {
                       return sum.missed == 0
                                  ? ""
                                  : fmt::format("{} ({} of {})", sum.method, sum.missed, sum.asked);
                     }));
}

std::string right_sentence(const std::vector<Sum>& sums) {
  return fmt::format("Right on every query, with no false positive either: {}.",
                     list(sums, [](const Sum& sum) { return sum.wrong == 0 ? sum.method : ""; }));
}

/// Nothing without times.
std::string time_sentence(const std::vector<Sum>& sums) {
  const std::string_view certified = fast::certified_info().name;
  const auto ours = std::ranges::find(sums, certified, &Sum::method);
  if (ours == sums.end() || ours->nanoseconds.is_empty()) return {};
  const std::string others = list(sums, [certified](const Sum& sum) -> std::string {
    if (sum.method == certified || sum.missed != 0 || sum.ratio.is_empty()) return {};
    return sum.method + " " + sum.ratio.text();
  });
  return fmt::format(
      "{} takes {} ns a query. As a multiple of that, the others that miss nothing: {}.", certified,
      ours->nanoseconds.text(), others);
}

/// Nothing without fronts.
std::string fronts_sentence(const std::vector<Figure>& figures) {
  std::map<std::string, int> fronts;
  int panels = 0;
  for (const Figure& figure : figures) {
    if (figure.form != FigureForm::points) continue;
    for (const FigurePanel& panel : figure.panels) {
      ++panels;
      for (const FigurePoint& point : panel.front) ++fronts[point.label];
    }
  }
  if (fronts.empty()) return {};
  return fmt::format(
      "On the Pareto front of time against error, among those that miss nothing: {} of {} panels.",
      list(fronts, [](const auto& of) { return fmt::format("{} in {}", of.first, of.second); }),
      panels);
}

/// What a method did that breaks its promise, in all measurements, the worst first.
struct Broken {
  std::string method;
  fast::Promise promise = fast::Promise::none;
  std::uint64_t misses = 0;
  std::uint64_t early = 0;
  std::uint64_t beyond = 0;
  std::uint64_t false_positives = 0;
  std::uint64_t late = 0;
  std::uint64_t errors = 0;
  double latest = 0.0;

  [[nodiscard]] std::string text() const {
    std::vector<std::string> texts;
    const auto add = [&](std::uint64_t count, const std::string& words) {
      if (count != 0) texts.push_back(fmt::format("{} {}", count, words));
    };
    add(misses, "missed collisions");
    add(late, latest > 0.0
                  ? fmt::format("late times, at most by {} of the step", short_number(latest))
                  : "late times");
    add(early, "early upper times");
    add(beyond, "beyond the tolerance");
    if (promise == fast::Promise::exact) add(false_positives, "false positives");
    add(errors, "errors");
    return fmt::format("{} ({})", method, fmt::join(texts, ", "));
  }
};

std::string promises_sentence(const Measurements& measurements) {
  std::vector<Broken> all;
  for (const Measurement& m : measurements.all) {
    if (m.keeps_promise) continue;
    auto broken = std::ranges::find(all, m.method, &Broken::method);
    if (broken == all.end()) {
      broken = all.insert(broken, {.method = m.method, .promise = m.promise});
    }
    broken->misses += m.false_negatives;
    broken->early += m.early_upper_tois;
    broken->beyond += m.beyond_tolerance;
    broken->false_positives += m.false_positives;
    broken->late += m.late_tois;
    broken->errors += m.errors;
    broken->latest = std::max(broken->latest, m.late.greatest.step);
  }
  if (all.empty()) return "Every method kept its promise.";
  const auto harm = [](const Broken& broken) {
    return std::tuple(broken.misses == 0, -broken.latest, broken.false_positives == 0);
  };
  std::ranges::stable_sort(all, {}, harm);
  return fmt::format("Broke its promise: {}.",
                     list(all, [](const Broken& broken) { return broken.text(); }));
}

/// Nothing if every method was asked all queries of its samples.
std::string unasked_sentence(const Measurements& measurements) {
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> counts;
  for (const Measurement& m : measurements.all) {
    if (m.outside + m.left_out == 0) continue;
    counts[m.method].first += m.outside;
    counts[m.method].second += m.left_out;
  }
  if (counts.empty()) return {};
  return fmt::format("Not asked: {}.", list(counts, [](const auto& of) {
                       const auto& [outside, left_out] = of.second;
                       return fmt::format(
                           "{} ({} queries outside its promise, {} for lack of time)", of.first,
                           outside, left_out);
                     }));
}

}  // namespace

std::vector<std::string> findings_of(const Measurements& measurements,
                                     const std::vector<Figure>& figures) {
  if (measurements.all.empty()) return {};
  std::vector<std::string> findings;
  const std::vector<Sum> sums = sums_of(measurements);
  if (!sums.empty()) {
    findings = {promises_sentence(measurements),
                queries_sentence(measurements, sums.size()),
                misses_sentence(sums),
                right_sentence(sums),
                time_sentence(sums),
                fronts_sentence(figures)};
  }
  if (sums.empty()) findings.push_back(promises_sentence(measurements));
  findings.push_back(unasked_sentence(measurements));
  std::erase(findings, "");
  return findings;
}

}  // namespace touchstone::verify::report

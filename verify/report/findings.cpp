#include "verify/report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "verify/report/tables.hpp"

namespace touchstone::verify {
namespace {

constexpr std::string_view certified = "certified";

/// A method's measurements of the field together.
struct Sum {
  std::string method;
  std::uint64_t asked = 0;
  std::uint64_t missed = 0;                   ///< false negatives and late times of impact
  std::uint64_t wrong = 0;                    ///< these, and all else that is wrong
  double shortest = INFINITY, longest = 0.0;  ///< nanoseconds a query
  double least_ratio = INFINITY, greatest_ratio = 0.0;  ///< of the certified solver's
};

void add(Sum& sum, const Measurement& m) {
  sum.asked += m.asked;
  sum.missed += m.false_negatives + m.late_tois;
  sum.wrong += m.false_negatives + m.late_tois + m.early_upper_tois + m.false_positives + m.errors;
  if (std::isnan(m.nanoseconds)) return;
  sum.shortest = std::min(sum.shortest, m.nanoseconds);
  sum.longest = std::max(sum.longest, m.nanoseconds);
  const double ratio = m.nanoseconds / m.certified_nanoseconds;
  if (std::isnan(ratio)) return;
  sum.least_ratio = std::min(sum.least_ratio, ratio);
  sum.greatest_ratio = std::max(sum.greatest_ratio, ratio);
}

/// In the order of the measurements.
std::vector<Sum> sums_of(const Measurements& measurements) {
  std::vector<Sum> sums;
  for (const Measurement* m : of_experiment(measurements, Experiment::field)) {
    const auto found = std::ranges::find(sums, m->method, &Sum::method);
    add(found == sums.end() ? sums.emplace_back(Sum{.method = m->method}) : *found, *m);
  }
  return sums;
}

/// "a, b (3)": those that fit, each as it is said; "none" without any.
std::string list(const std::vector<Sum>& sums, const std::function<bool(const Sum&)>& fits,
                 const std::function<std::string(const Sum&)>& say) {
  std::string text;
  for (const Sum& sum : sums) {
    if (fits(sum)) text += (text.empty() ? "" : ", ") + say(sum);
  }
  return text.empty() ? "none" : text;
}

std::string name_of(const Sum& sum) { return sum.method; }

/// "3 to 12", "3" where both are the same in short.
std::string range_text(double least, double greatest) {
  const std::string from = short_number(least), to = short_number(greatest);
  return from == to ? from : from + " to " + to;
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
  const auto misses = [](const Sum& sum) { return sum.missed != 0; };
  return fmt::format("No missed collision and no time of impact after the exact one: {}. Some: {}.",
                     list(sums, std::not_fn(misses), name_of),
                     list(sums, misses, [](const Sum& sum) {
                       return fmt::format("{} ({} of {})", sum.method, sum.missed, sum.asked);
                     }));
}

std::string right_sentence(const std::vector<Sum>& sums) {
  return fmt::format("Right on every query, with no false positive either: {}.",
                     list(
                         sums, [](const Sum& sum) { return sum.wrong == 0; }, name_of));
}

/// Nothing without times.
std::string time_sentence(const std::vector<Sum>& sums) {
  const auto ours = std::ranges::find(sums, certified, &Sum::method);
  if (ours == sums.end() || ours->longest == 0.0) return {};
  const auto is_other = [](const Sum& sum) {
    return sum.method != certified && sum.missed == 0 && sum.greatest_ratio != 0.0;
  };
  return fmt::format(
      "{} takes {} ns a query. As a multiple of that, the others that miss nothing: {}.", certified,
      range_text(ours->shortest, ours->longest), list(sums, is_other, [](const Sum& sum) {
        return fmt::format("{} {}", sum.method, range_text(sum.least_ratio, sum.greatest_ratio));
      }));
}

/// Nothing without fronts.
std::string fronts_sentence(const std::vector<Figure>& figures) {
  std::vector<std::pair<std::string, int>> on_front;
  int panels = 0;
  for (const Figure& figure : figures) {
    if (figure.form != FigureForm::points) continue;
    for (const FigurePanel& panel : figure.panels) {
      ++panels;
      for (const FigurePoint& point : panel.front) {
        const auto found =
            std::ranges::find(on_front, point.label, &std::pair<std::string, int>::first);
        ++(found == on_front.end() ? on_front.emplace_back(point.label, 0) : *found).second;
      }
    }
  }
  if (on_front.empty()) return {};
  std::string names;
  for (const auto& [name, count] : on_front) {
    names += fmt::format("{}{} in {}", names.empty() ? "" : ", ", name, count);
  }
  return fmt::format(
      "On the Pareto front of time against error, among those that miss nothing: {} of {} panels.",
      names, panels);
}

std::string promises_sentence(const Measurements& measurements) {
  std::vector<std::string> broken;
  for (const Measurement& m : measurements.all) {
    if (m.keeps_promise || std::ranges::find(broken, m.method) != broken.end()) continue;
    broken.push_back(m.method);
  }
  return broken.empty() ? "Every method kept its promise."
                        : fmt::format("Broke its promise: {}.", fmt::join(broken, ", "));
}

}  // namespace

std::vector<std::string> findings_of(const Measurements& measurements,
                                     const std::vector<Figure>& figures) {
  if (measurements.all.empty()) return {};
  std::vector<std::string> findings;
  const std::vector<Sum> sums = sums_of(measurements);
  if (!sums.empty()) {
    findings = {queries_sentence(measurements, sums.size()), misses_sentence(sums),
                right_sentence(sums), time_sentence(sums), fronts_sentence(figures)};
  }
  findings.push_back(promises_sentence(measurements));
  std::erase(findings, "");
  return findings;
}

}  // namespace touchstone::verify

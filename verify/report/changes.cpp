#include "verify/report/changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::verify::report {
namespace {

constexpr const char* same = "=";

const Measurement* find_alike(const std::vector<const Measurement*>& all,
                              const Measurement& wanted) {
  const auto found = std::ranges::find_if(all, [&](const Measurement* m) {
    return m->group == wanted.group && m->kind == wanted.kind && m->method == wanted.method;
  });
  return found == all.end() ? nullptr : *found;
}

/// The digest of a group's queries, if it is known.
std::optional<std::uint64_t> digest_of(const Measurements& measurements, const Measurement& m) {
  for (const MeasuredGroup& group : measurements.groups) {
    if (group.name == m.group && group.kind == m.kind) return group.digest;
  }
  return std::nullopt;
}

std::string count_text(const Measurement& before, const Measurement& after,
                       std::uint64_t Measurement::*count) {
  if (before.*count == after.*count && before.asked == after.asked) return same;
  if (before.*count == 0 && after.*count == 0) return same;
  return fmt::format("{} of {} → {} of {}", before.*count, before.asked, after.*count, after.asked);
}

std::string time_text(const Measurement& before, const Measurement& after) {
  const double old_ratio = before.nanoseconds / before.certified_nanoseconds;
  const double new_ratio = after.nanoseconds / after.certified_nanoseconds;
  const bool is_changed =
      new_ratio > changed_time * old_ratio || old_ratio > changed_time * new_ratio;
  return is_changed ? fmt::format("{} → {}", short_number(old_ratio), short_number(new_ratio))
                    : same;
}

}  // namespace

Table changes_between(const Measurements& before, const Measurements& after) {
  Table table{
      .title = fmt::format("since {}", before.date.empty() ? "an earlier run" : before.date),
      .columns = {"method", "FN", "FP", "late", "÷ certified", "data"},
      .rows = {}};
  const auto old_ones = of_experiment(before, Experiment::field);
  const auto new_ones = of_experiment(after, Experiment::field);
  const auto data_text = [](const Measurement& m) {
    return fmt::format("{}, {}", m.group, to_string(m.kind));
  };
  for (const Measurement* m : new_ones) {
    const Measurement* const old = find_alike(old_ones, *m);
    if (old == nullptr) {
      table.rows.push_back({m->method, "new", "new", "new", "new", data_text(*m)});
      continue;
    }
    std::vector<std::string> row{m->method, count_text(*old, *m, &Measurement::false_negatives),
                                 count_text(*old, *m, &Measurement::false_positives),
                                 count_text(*old, *m, &Measurement::late_tois),
                                 time_text(*old, *m)};
    const auto old_digest = digest_of(before, *old), new_digest = digest_of(after, *m);
    const bool is_other_data = old_digest && new_digest && *old_digest != *new_digest;
    if (std::all_of(row.begin() + 1, row.end(), [](const auto& text) { return text == same; })) {
      continue;
    }
    row.push_back(data_text(*m) + (is_other_data ? " (other queries)" : ""));
    table.rows.push_back(std::move(row));
  }
  for (const Measurement* m : old_ones) {
    if (find_alike(new_ones, *m) != nullptr) continue;
    table.rows.push_back({m->method, "gone", "gone", "gone", "gone", data_text(*m)});
  }
  return table;
}

}  // namespace touchstone::verify::report

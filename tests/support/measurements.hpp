#pragma once

/// \file
/// Artificial measurements for tests of reports, few and with simple numbers.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "verify/report/measurement.hpp"
#include "verify/report/stability.hpp"

namespace touchstone::tests {

/// A method that solved 100 of 200 queries, of which 20 collide.
[[nodiscard]] inline verify::report::Measurement measured(const std::string& group,
                                                          const std::string& method,
                                                          double nanoseconds,
                                                          std::uint64_t false_positives = 0,
                                                          std::uint64_t false_negatives = 0) {
  verify::report::Measurement m;
  m.group = group;
  m.method = method;
  m.tolerance = 1e-6;
  m.max_checks = 1'000'000;
  m.group_queries = 200;
  m.asked = 100;
  m.collisions = 20;
  m.false_positives = false_positives;
  m.false_negatives = false_negatives;
  m.nanoseconds = nanoseconds;
  m.repetitions = 5;
  m.certified_nanoseconds = 10.0;
  m.collision_times.bins = {{8, 15}, {16, 5}};
  m.no_collision_times.bins = {{0, 80}};
  return m;
}

/// The same measurement over a parameter of an experiment.
[[nodiscard]] inline verify::report::Measurement measured_in(verify::report::Experiment experiment,
                                                             const std::string& method,
                                                             double nanoseconds) {
  verify::report::Measurement m = measured("handcrafted", method, nanoseconds);
  m.experiment = experiment;
  return m;
}

/// A report with an example of everything: on "handcrafted", vertex-face, certified,
/// tight_inclusion and msrf; certified is exact, tight_inclusion has 8 false positives, msrf 1 and
/// 2 false negatives. The released filter of Tight-Inclusion misses 2 of 20 contacts at t=1, and of
/// a family's.
[[nodiscard]] inline verify::report::Measurements small_report() {
  using verify::report::Experiment;
  verify::report::Measurements report;
  report.command = "touchstone report handcrafted --out 'a <page>.html'";
  report.machine = "a machine";
  report.date = "2026-01-31";
  verify::report::Measurement certified = measured("handcrafted", "certified", 10.0);
  certified.toi_error = verify::report::Spread{.count = 20, .median = 0.0, .max = 1e-13};
  certified.stages = {{"axis", 75}, {"exact", 25}};
  verify::report::Measurement inclusion = measured("handcrafted", "tight_inclusion", 2500.0, 8);
  inclusion.toi_error = verify::report::Spread{.count = 20, .median = 1e-7, .max = 0.5};
  report.all = {certified, inclusion, measured("handcrafted", "msrf", 400.0, 1, 2)};
  for (const double tolerance : {1e-8, 1.0}) {
    verify::report::Measurement m =
        measured_in(Experiment::tolerance, "tight_inclusion", 1.0 / tolerance);
    m.tolerance = tolerance;
    m.false_positives = tolerance == 1.0 ? 40 : 0;
    report.all.push_back(m);
  }
  for (const char* const method : {"certified", "tight_inclusion", "msrf"}) {
    verify::report::Measurement m = measured_in(Experiment::separation, method, 30.0);
    m.separation = {.distance = 1e-8,
                    .norm = std::string(method) == "msrf" ? Norm::l2 : Norm::linf};
    report.all.push_back(m);
  }
  verify::report::Measurement limited = measured_in(Experiment::checks, "tight_inclusion", 50.0);
  limited.max_checks = 10;
  limited.at_limit = 25;
  limited.achieved_tolerance = verify::report::Spread{.count = 45, .median = 0.25, .max = 0.5};
  report.all.push_back(limited);
  for (const char* const method : {"tight_inclusion", "tight_inclusion_released"}) {
    for (const double scale : {0.0, 0.01}) {
      const std::string group = scale == 0.0 ? "a-family" : "contact at t=1, two decimals";
      const bool is_released = std::string(method) == "tight_inclusion_released";
      verify::report::Measurement m =
          measured(group, method, verify::report::Measurement::unknown, 0, is_released ? 2 : 0);
      m.experiment = Experiment::filter;
      if (scale != 0.0) m.scale = scale;
      report.all.push_back(m);
    }
  }
  verify::report::StabilityMark mark{{.collisions = 10, .false_negatives = 4, .nanoseconds = 7.0}};
  mark.method = "msrf";
  mark.hardness = "angle";
  mark.measure = "angle to parallel";
  mark.exponent = -5;
  mark.kind = Kind::edge_edge;
  mark.queries = 20;
  mark.worst = verify::judge::Fault::false_negative;
  mark.worst_rate = 0.4;
  report.stability.push_back(mark);
  return report;
}

/// A level for each number, as the error of the time of impact, as time in nanoseconds, and as
/// checks; every other one has a false negative.
[[nodiscard]] inline verify::report::StabilityResult map_of(const std::vector<double>& numbers,
                                                            const std::string& method = "planted") {
  using namespace verify;
  report::StabilityResult result;
  result.count = 1;
  const generate::Hardness& hardness = generate::hardness_from_name("distance");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    report::StabilityCell cell{
        .sort = {.hardness = &hardness,
                 .level = hardness.levels.at(i % hardness.levels.size()),
                 .kind = i < hardness.levels.size() ? Kind::vertex_face : Kind::edge_edge},
        .judged = {}};
    cell.judged.queries = cell.judged.collisions = 1;
    jobs::MethodResult judged{
        .name = method, .promise = fast::Promise::conservative, .timed = true, .judgement = {}};
    judged.judgement.queries = judged.judgement.collisions = 1;
    judged.judgement.toi_errors.add(numbers[i]);
    judged.judgement.nanoseconds = numbers[i];
    judged.judgement.checks = static_cast<std::uint64_t>(std::min(numbers[i], 1e15));
    judged.judgement.faults[static_cast<std::size_t>(judge::Fault::false_negative)] = i % 2;
    cell.judged.methods.push_back(judged);
    result.total += cell.judged;
    result.cells.push_back(cell);
  }
  return result;
}

}  // namespace touchstone::tests

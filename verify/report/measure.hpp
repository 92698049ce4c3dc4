#pragma once

/// \file
/// Measures methods on one group of queries, side by side.
///
/// **Sample and time.** As in verify/jobs/timing.hpp. A sample grows until it would take the
/// method, or the reference, more than MeasureOptions::seconds. Queries that were not asked are not
/// counted. Each query is also timed alone, for the histograms. The reference runs on each of the
/// samples too, so that ratios compare the same queries.
///
/// Where settings of a method are compared (MeasureOptions::same_sample), all of them are asked the
/// smallest of their samples.
///
/// **Truth.** That of the oracle, for the separation that the method is asked for.

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "fast/method.hpp"
#include "verify/data/query_group.hpp"
#include "verify/judge/ground_truth_cache.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/report/measurement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::report {

/// A method under some options. The truth is about their separation.
struct Setting {
  const fast::Method* method = nullptr;  ///< not null
  fast::MethodOptions options;
  /// In child processes, under MeasureOptions::process; else in this process.
  bool in_children = false;
  /// Wall-clock seconds that it may take; after that it is asked no more queries.
  double allowance = std::numeric_limits<double>::infinity();
};

/// Called with each query that a method answered wrongly, and that answer: one that breaks the
/// method's promise. Some of a great many are left out.
using OnWrong = std::function<void(judge::WrongQuery)>;

struct MeasureOptions {
  Experiment experiment = Experiment::field;
  /// The greatest number of queries that are asked of a group; positive.
  std::size_t count = 10'000;
  /// Processor seconds that the sample of a method may take; positive. All work with a method takes
  /// a few times as long.
  double seconds = 1.0;
  /// Repetitions; times are medians, of fewer where one takes longer than `seconds`; at least 1.
  std::size_t repetitions = 5;
  solvers::SolverProcessOptions process = {};
  /// Settings of one method are asked the same queries.
  bool same_sample = false;
  /// Called now and then with the fraction that is done.
  std::function<void(double)> on_progress = nullptr;
  OnWrong on_wrong = nullptr;
  /// May be null. Once true, no further work begins.
  const std::atomic<bool>* stop = nullptr;
};

/// Measures the settings on the group of `truths`, in their order. Once stopped, those are left out
/// that have no time, no reference or no truth yet.
/// \param reference the method whose time stands in Measurement::certified_nanoseconds
/// \throws std::invalid_argument for options out of range or an empty group.
[[nodiscard]] std::vector<Measurement> measure(const data::QueryGroup& group,
                                               judge::GroundTruthCache& truths,
                                               std::span<const Setting> settings,
                                               const fast::Method& reference,
                                               const MeasureOptions& options);

/// Judges the answers of a method to all queries of the group of `truths`; nothing is timed. No
/// result once *stop is true (it may be null).
[[nodiscard]] std::optional<Measurement> judge_all(
    const data::QueryGroup& group, judge::GroundTruthCache& truths, const fast::Method& method,
    const fast::MethodOptions& options, Experiment experiment,
    const std::atomic<bool>* stop = nullptr, const OnWrong& on_wrong = nullptr);

}  // namespace touchstone::verify::report

#pragma once

/// \file
/// The experiments of a report, and their run over groups of queries.
///
/// - *field*: every method as it is meant to be used, without separation (the paper's table 1).
/// - *separation*: methods that measure a distance, at d from 1e-100 to 1, each in its own norms
///   and judged in them (tables 2, 3).
/// - *tolerance*: methods that are driven by a tolerance, at δ from 1e-8 to 1.
/// - *checks*: Tight-Inclusion with m_I from 10 to 1,000,000.
/// - *filter*: Tight-Inclusion with its three filters, the derived, the published and the released
///   one, if more than one of them takes part: the misses of each among the built-in families, and
///   among contacts at t=1 (verify/generate/workload.hpp) at scales from 0.001 to 1000. It has
///   queries of its own, of the kinds of the groups.
/// - *stability*: every method on the hard queries of verify/generate/hardness.hpp.
///
/// The fast::MethodInfo of a method says in which experiments it takes part. Variants of a method
/// take part in *field*, *filter* and *stability*.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/data/query_group.hpp"
#include "verify/report/measure.hpp"
#include "verify/report/measurement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::report {

struct ExperimentOptions {
  /// Names of methods; all there are if empty. Each is measured on the groups whose curves it
  /// takes.
  std::vector<std::string> methods = {};
  /// Further methods: in child processes under these options, in *field* and *stability*.
  std::vector<const fast::Method*> plugins = {};
  solvers::SolverProcessOptions process = {};
  /// Those to do; all if empty.
  std::vector<Experiment> experiments = {};
  /// The greatest number of queries of a group that are asked, an evenly spread sample; positive. A
  /// quarter of them are asked over the separation, fourteen times, where the oracle takes longest.
  /// In the experiment on filters it bounds those of a family (at most 500) and of a scale (at most
  /// 10,000).
  std::size_t count = 2000;
  /// MeasureOptions::seconds, of a method on a group in a trial.
  double seconds = 0.2;
  std::size_t repetitions = 5;
  /// Queries a cell of the map of stability; 0: no map.
  std::uint64_t stability_count = 20;
  std::uint64_t seed = 2021;
  /// Cores that the oracle may use; 0: all. Methods are timed in one thread.
  unsigned threads = 0;
  /// Wall-clock seconds of the whole run; 0: no limit. With a limit the seconds above are chosen to
  /// fit, plugins have an equal share each, and work beyond the limit is skipped.
  double budget = 0.0;
  std::function<void(double)> on_progress = nullptr;
  /// MeasureOptions::on_wrong, in the experiments on groups and on filters.
  OnWrong on_wrong = nullptr;
  /// May be null. Once true, the result has the measurements so far.
  const std::atomic<bool>* stop = nullptr;
};

/// Makes all measurements of a report. `command` is left to the caller.
/// \throws std::invalid_argument for an unknown method, options out of range, or an empty group.
[[nodiscard]] Measurements run_experiments(std::span<const data::QueryGroup> groups,
                                           const ExperimentOptions& options = {});

}  // namespace touchstone::verify::report

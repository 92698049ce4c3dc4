#pragma once

/// \file
/// Judges methods on queries of growing difficulty: each on the hard queries (hardness.hpp) of
/// every sort, level and kind, one cell of a map each.
///
/// The truth of a query comes twice: from the certified solver as its label, and from the oracle,
/// which judges; where they differ, that is counted as a wrong label (CertifyResult). All but
/// the times is a function of options and methods, the same for any number of threads.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"
#include "verify/stability/hardness.hpp"

namespace touchstone::verify::stability {

struct StabilityOptions {
  /// Minimum separation, where the level does not scale it. \pre has_hard_queries()
  Separation separation = fast::no_separation;
  std::uint64_t seed = 0;
  /// Queries a cell, half of them collisions.
  std::uint64_t count = 200;
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// Judged on every query; not null.
  std::vector<const solvers::Solver*> solvers = {};
  /// Called now and then with the fraction that is done; never from two threads at once.
  std::function<void(double)> on_progress = nullptr;
  /// May be null. Once true, the result is that of what was judged so far.
  const std::atomic<bool>* stop = nullptr;
  /// Wall-clock time, shared over cells and solvers (jobs/budget.hpp); 0: no limit.
  double seconds = 0.0;
};

/// The judgement on the queries of one sort.
struct StabilityCell {
  const Hardness* hardness = nullptr;
  int level = 0;
  Kind kind = Kind::vertex_face;
  jobs::CertifyResult judged;
};

struct StabilityResult {
  Separation separation = fast::no_separation;
  std::uint64_t seed = 0;
  std::uint64_t count = 0;
  /// Methods with what they were held to, judged on all cells.
  jobs::CertifyResult total;
  /// By hardness, then kind, then level, each in its order.
  std::vector<StabilityCell> cells;
  std::size_t unjudged_cells = 0;  ///< of those asked for, for lack of time or a stop
};

/// Judges the solvers on the hard queries of the given sorts.
/// \throws std::invalid_argument if there are no hard queries about the separation.
[[nodiscard]] StabilityResult measure_stability(const std::vector<const Hardness*>& sorts,
                                                const StabilityOptions& options);

/// Faults of a method in some queries.
struct Outcome {
  /// The worst of it (judge::worst_of), nothing if nothing is wrong.
  std::optional<judge::Fault> worst = std::nullopt;
  bool is_slight = false;  ///< Is it a time that is late slightly?
  /// The rate of a fault as a fraction of the queries where it is possible: of those that collide
  /// (false negatives, times of impact), of those that do not (false positives, nearness), or of
  /// all.
  double rate = 0.0;
};

/// The outcome of method number `method` of a result.
[[nodiscard]] Outcome outcome_of(const jobs::CertifyResult& judged, std::size_t method);

/// The rate of that fault, as above; 0 if there was no query where it is possible.
[[nodiscard]] double rate_of(judge::Fault fault, const jobs::CertifyResult& judged,
                             std::size_t method);

/// Mean number of checks, where the method counts them.
[[nodiscard]] std::optional<double> checks_per_query(const jobs::MethodResult& method);

/// Mean processor time, where it is known.
[[nodiscard]] std::optional<double> nanoseconds_per_query(const jobs::MethodResult& method);

/// Has a method broken its promise, or do certified solver and oracle differ on a query?
[[nodiscard]] bool has_wrong_answers(const StabilityResult& result);

}  // namespace touchstone::verify::stability

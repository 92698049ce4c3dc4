#pragma once

/// \file
/// Speed and error of solvers on one group of queries, in one run.
///
/// **Speed.** As in timing.hpp. Each repetition times every solver once and, among them, a pass
/// that only reads the queries: the physical limit. The median of the repetitions counts. A solver
/// that would take longer than BenchOptions::seconds for all queries is timed on a sample.
/// Afterwards single queries are timed.
///
/// **Error.** Queries are decided by the oracle and the answers to them judged. In large groups the
/// oracle decides an evenly spread sample, and the queries that any solver calls a collision (or is
/// undecided about, or in error). Every counted fault is real. All false positives are found
/// (unless there are more than BenchOptions::judge); a false negative outside of the sample is
/// found only if another solver calls it a collision.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/data/query_group.hpp"
#include "verify/jobs/timing.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

struct BenchOptions {
  /// Minimum separation, for the solvers and for the ground truth.
  Separation separation = {};
  /// At least 1.
  std::size_t repetitions = 5;
  /// A solver is timed on as many queries as take it about this long; positive.
  double seconds = 2.0;
  /// The number of queries that are judged of a larger group, and the greatest number of further
  /// ones that a solver calls a collision; 0: none.
  std::size_t judge = 200'000;
  /// The greatest number of single queries that are timed; 0: none.
  std::size_t singles = 20'000;
  /// Cores to use for the oracle; 0: all of them. Solvers run on one.
  unsigned threads = 0;
  /// Called now and then with the fraction of the group's work that is done, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further work begins, and the result is partial.
  const std::atomic<bool>* stop = nullptr;
};

/// Nanoseconds that single queries take, one call each, without the clock's own cost. Each is the
/// shortest of up to three sweeps over the queries, which leaves out other work of the machine.
struct SingleTimes {
  std::size_t queries = 0;
  double mean = 0.0;
  double p50 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// One solver's part in a result.
struct SolverResult {
  std::string name;
  fast::Promise promise = fast::Promise::none;
  /// The number of queries that it is timed on: those that it answered.
  std::size_t queries = 0;
  TimesPerQuery times;
  /// Empty if they were not timed.
  std::optional<SingleTimes> singles;
  /// The stages that ended its queries; empty if it has none.
  std::vector<solvers::StageCount> stages;
  /// The judgement on its answers to the queries that were judged; `index` of a wrong answer is the
  /// position in the group. toi_errors is the distance from toi_lower to the exact time of impact.
  judge::Judgement judgement;
  /// The sources of the queries of judgement.wrong_answers, in the same order.
  std::vector<data::QueryPlace> wrong_places;
};

/// Results of a run on one group.
struct BenchResult {
  std::string name;  ///< of the group
  Kind kind = Kind::vertex_face;
  Separation separation = {};
  std::size_t queries = 0;
  std::size_t judged = 0;      ///< queries decided by the oracle
  std::size_t collisions = 0;  ///< of these
  TimesPerQuery memory_pass;
  /// In the order of the solvers.
  std::vector<SolverResult> solvers;
  bool interrupted = false;
};

/// True if the solver gave a wrong answer that its promise excludes. Without a promise it breaks
/// none.
[[nodiscard]] bool broke_promise(const SolverResult& result);

/// True if any solver broke its promise.
[[nodiscard]] bool any_broke_promise(std::span<const BenchResult> results);

/// Times and judges the solvers on the group.
/// \throws std::invalid_argument for options out of range or an empty group, and whatever a solver
/// throws.
[[nodiscard]] BenchResult bench(const data::QueryGroup& group,
                                std::span<const solvers::Solver* const> solvers,
                                const BenchOptions& options = {});

}  // namespace touchstone::verify::jobs

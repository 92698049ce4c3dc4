#pragma once

/// \file
/// Speed and error of solvers on one group of queries, in one run.
///
/// **Speed.** As in timing.hpp. Each repetition times every solver once and, among them, a pass
/// that only reads the queries: the physical limit. What counts is the median of the repetitions. A
/// solver that would take longer than BenchOptions::seconds for all queries is timed on a sample.
/// Afterwards single queries are timed.
///
/// **Error.** Queries are decided by the oracle and the answers to them judged. Of large groups not
/// all queries are: an evenly spread sample, and those that any solver calls a collision (or is
/// undecided about, or in error). So all that are counted are true, false positives are all there
/// are among the answers (unless there are more than BenchOptions::judge), and a false negative
/// outside of the sample is found only if another solver calls it a collision.

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
  /// Of a group with more queries so many are judged, and at most as many again that any solver
  /// calls a collision; 0: none.
  std::size_t judge = 200'000;
  /// At most so many single queries are timed; 0: none.
  std::size_t singles = 20'000;
  /// Cores to use for the oracle; 0: all of them. Solvers run on one.
  unsigned threads = 0;
  /// Called now and then with the fraction of the group's work that is done, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further work is begun and the result is what is known by then.
  const std::atomic<bool>* stop = nullptr;
};

/// Nanoseconds that single queries take, one call each, without what the clock itself takes. Each
/// is the shortest of up to three sweeps over the queries, so that what else happens on the machine
/// is left out.
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
  /// Timed on so many queries: those that it answered.
  std::size_t queries = 0;
  Times times;
  /// Empty if they were not timed.
  std::optional<SingleTimes> singles;
  /// Which stages ended its queries; empty if it has none.
  std::vector<solvers::StageCount> stages;
  /// Of its answers to queries that were judged; `index` of a wrong answer is the position in the
  /// group. toi_errors is the distance from toi_lower to the exact time of impact.
  judge::Judgement judgement;
  /// Where the queries of judgement.wrong_answers come from, in the same order.
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
  Times memory_pass;
  /// In the order of the solvers.
  std::vector<SolverResult> solvers;
  bool interrupted = false;
};

/// Did the solver give a wrong answer that its promise excludes? Without a promise it breaks none.
[[nodiscard]] bool broke_promise(const SolverResult& result);

/// Does any? See broke_promise.
[[nodiscard]] bool any_broke_promise(std::span<const BenchResult> results);

/// Times and judges the solvers on the group.
/// \throws std::invalid_argument for options out of range or an empty group, and whatever a solver
/// throws.
[[nodiscard]] BenchResult bench(const data::QueryGroup& group,
                                std::span<const solvers::Solver* const> solvers,
                                const BenchOptions& options = {});

}  // namespace touchstone::verify::jobs

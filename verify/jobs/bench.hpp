#pragma once

/// \file
/// Speed and error of a solver on one group of queries: a row of `touchstone bench`.
///
/// **Speed.** As in timing.hpp. A solver that would take longer than BenchOptions::seconds for all
/// queries is timed on a sample. Each repetition times the solver, the certified solver on the same
/// sample, and a pass that only reads the queries of the group: the physical limit. The three take
/// turns, so that rows measured at different times can be compared. The median of the repetitions
/// counts. Afterwards single queries are timed, if asked for.
///
/// **Error.** Queries are decided by the oracle and the answers to them judged. In large samples
/// the oracle decides an evenly spread part, and the queries that the solver or the certified
/// solver calls a collision (or is undecided about, or in error), up to BenchOptions::judge each.
/// Every counted fault is real.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/data/query_group.hpp"
#include "verify/judge/ground_truth_cache.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

struct BenchOptions {
  /// At least 1.
  std::size_t repetitions = 5;
  /// A solver is timed on as many queries as take it about this long; positive.
  double seconds = 2.0;
  /// The number of queries that are judged of a larger sample, and the greatest number of further
  /// ones that are called a collision; 0: none.
  std::size_t judge = 200'000;
  /// The greatest number of single queries that are timed; 0: none.
  std::size_t singles = 0;
  /// Cores to use for the oracle; 0: all of them. Solvers run on one.
  unsigned threads = 0;
  /// Called now and then with the fraction of a row's work that is done, from this thread.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further work begins, and the row is partial.
  const std::atomic<bool>* stop = nullptr;
};

/// Nanoseconds that single queries take, one call each, without the clock's own cost.
struct SingleTimes {
  double mean = 0.0;
  double p50 = 0.0;
  double p99 = 0.0;
};

/// A solver under some settings on a group.
struct BenchRow {
  std::string source;  ///< the name of the group
  AnyKind kind = ContactKind::vertex_face;
  /// Of a family of growing difficulty; nothing for others.
  std::optional<int> level = std::nullopt;
  std::string method;
  fast::Promise promise = fast::Promise::none;
  /// The tolerance and the limit of checks that it was asked with, and the separation.
  fast::MethodOptions options;
  std::size_t queries = 0;  ///< of the group
  std::size_t timed = 0;    ///< of these, an evenly spread sample
  /// Nanoseconds a query: medians, NaN if there was no repetition.
  double nanoseconds = 0.0;
  double certified_nanoseconds = 0.0;  ///< of the certified solver on the same sample
  double pass_nanoseconds = 0.0;       ///< of a pass that only reads the queries
  /// Empty if they were not timed.
  std::optional<SingleTimes> singles;
  /// Queries of the sample that it gave up, or that took as many checks as it may do.
  std::uint64_t at_limit = 0;
  /// The judgement on its answers to the queries that were judged.
  judge::Judgement judgement;
  bool interrupted = false;
};

/// True if the solver gave a wrong answer that its promise excludes. Without a promise it breaks
/// none.
[[nodiscard]] bool broke_promise(const BenchRow& row);

/// The rows of one group; the oracle decides a query once for all of them.
class Bench {
 public:
  /// Group and options must live as long as this.
  /// \throws std::invalid_argument for options out of range or an empty group.
  Bench(const data::QueryGroup& group, const BenchOptions& options);

  /// Times and judges a solver. \param asked its settings, of which the separation is used
  /// \throws whatever the solver throws.
  [[nodiscard]] BenchRow row(const solvers::Solver& solver, const fast::MethodOptions& asked);

 private:
  const data::QueryGroup& group_;
  const BenchOptions& options_;
  judge::GroundTruthCache truths_;
  std::unique_ptr<fast::Method> certified_;
};

}  // namespace touchstone::verify::jobs

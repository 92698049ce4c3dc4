#pragma once

/// \file
/// A solver in a child process that lives on: asked block after block, at the price of a message
/// each, so that a solver that crashes, hangs or takes all memory costs one query and not the run.
///
/// Queries and answers lie in memory shared with the child, and so does its heartbeat: the number
/// of the query that it is at. It is asked in batches of one fixed size. If a batch ends the child,
/// or the number stays the same for longer than the limit of time, a new child solves the queries
/// of the batch one by one; a query that ends it is asked once more, alone in a child of its own,
/// before that counts as its failure, and the next child goes on after it. The limit is one for
/// each query, and does not change the measured time of a solver.
///
/// Limits and the relation of the child to this process: child_process.hpp.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/base/deadline.hpp"
#include "verify/judge/fault.hpp"
#include "verify/solvers/child_process.hpp"

namespace touchstone::verify::solvers {

struct SolverProcessOptions {
  /// Wall-clock seconds that a query may take, or up to five times as many while it waits for a
  /// processor; 0: no limit. Finite and not negative.
  double query_limit_seconds = 0.0;
  /// The number of crashes, exits and hangs after which the rest of a call is left unanswered; 0:
  /// no limit.
  std::size_t most_failures = 0;
  /// May be null. Once true, the child is ended within a quarter of a second.
  const std::atomic<bool>* stop = nullptr;
  ChildLimits limits = {};
};

/// The deadlines of a call; each may be without a limit.
struct SolverDeadlines {
  /// The time at which a call stops, even in the midst of a query; at most a quarter of a second
  /// late.
  base::Deadline end = {};
  /// No batch is begun after it; one that was begun may end.
  base::Deadline begin = {};
};

/// The result of one call.
struct SolverRun {
  /// Queries answered, from the first on; those with a failure count. Fewer than were asked if it
  /// was stopped, at the limit of failures, or out of time.
  std::size_t answered = 0;
  /// Crashes, exits, exceptions and hangs, by ascending position: the query causes it alone, too.
  /// (All other failures are in the answers: failure_of.)
  std::vector<judge::QueryFailure> failures = {};
  /// The number of times that it ended its process at queries none of which does so alone. These
  /// are answered.
  std::uint64_t unplaced_crashes = 0;
  /// Processor time of the solver, all its threads, without the making of children. A query that
  /// failed counts with the time it took the last time.
  double processor_seconds = 0.0;
  /// Wall-clock time of the same.
  double wall_seconds = 0.0;
};

/// Asks one method. May be used by one thread after the other, by one at a time.
class SolverProcess {
 public:
  /// The method must live as long as this object. Makes no process yet: the child is made at the
  /// first call, and first asks the method an empty array, so that it loads what it needs.
  explicit SolverProcess(const fast::Method& method, const SolverProcessOptions& options = {});
  SolverProcess(const SolverProcess&) = delete;
  SolverProcess& operator=(const SolverProcess&) = delete;
  SolverProcess(SolverProcess&&) = delete;
  SolverProcess& operator=(SolverProcess&&) = delete;
  ~SolverProcess();

  /// Answers query i in answers[i]: as the method does, undecided if it takes too long, error if it
  /// fails otherwise.
  /// \pre as many answers as queries.
  /// \throws std::system_error if the system has no memory, process or temporary folder left.
  [[nodiscard]] SolverRun solve(const AnyQueries& queries, std::span<fast::Answer> answers,
                                const fast::MethodOptions& method_options,
                                const SolverDeadlines& deadlines = {});

  /// The limit of the queries asked from now on, in place of that of the options.
  void set_query_limit(double seconds);

  /// The output of its child processes since the last call, which clears it.
  [[nodiscard]] CapturedOutput take_output();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchstone::verify::solvers

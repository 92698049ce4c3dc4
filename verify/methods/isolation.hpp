#pragma once

/// \file
/// Solving in a child process, so that a solver that crashes or hangs costs one query and not the
/// run.
///
/// The child is a copy of this process made by fork(). It writes its answers, and before each step
/// the index of the query it is at, into memory shared with the parent, which sleeps until the
/// child ends or the limit is near. If the child dies, or stays at one query for longer than the
/// limit and is killed, the query it was at gets its answer from the parent and a new child goes on
/// behind it.
///
/// Without a limit the index is that of a span of queries, so that solvers of a few nanoseconds a
/// query are not slowed down and solvers of many queries at once see many. If a span kills its
/// child, a new child solves the span again one by one, to find out which query it was. If none of
/// them does it again, their answers stand, but the death is counted.
///
/// In the child there are no other threads: fork() copies only the one that calls it. A method that
/// hands work to threads of a pool that existed before waits for ever. Each child leads a process
/// group of its own: the keys of a terminal do not reach it, and what it has started in turn (unless
/// that left the group) is killed when it ends.

#include <atomic>
#include <cstdint>
#include <span>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::verify {

struct IsolationOptions {
  /// Wall-clock seconds that a query may take (a tenth or some milliseconds more where the parent
  /// looks late); 0: no limit.
  double query_limit_seconds = 0.0;
  /// May be null. Once true, the child is killed within a quarter of a second.
  const std::atomic<bool>* stop = nullptr;
};

/// How it went, apart from the answers.
struct IsolatedSolve {
  /// Processor time of the solver in all children, without the making of the children. A query that
  /// hit the limit counts with the time it burnt.
  double processor_seconds = 0.0;
  /// Wall-clock time of the same.
  double wall_seconds = 0.0;
  /// Queries that hit the limit, answered Verdict::undecided.
  std::uint64_t limit_hits = 0;
  /// Queries that ended the child (by a signal, an exception or an exit), answered Verdict::error.
  std::uint64_t crashes = 0;
  /// Children that a span of queries ended and none of its queries alone: these are answered.
  std::uint64_t unplaced_crashes = 0;
  /// Was it stopped? Then not all queries are answered.
  bool stopped = false;
};

/// Answers query i in answers[i], as the method itself would, in child processes; returns when all
/// are answered or it is stopped. May be called from several threads at once. Each call makes at
/// least one child, at the price of a fork(), which grows with the memory of this process (some
/// milliseconds for 100 MB): the spans should be long. The children do not outlive this process,
/// and write no core files.
/// \pre both spans have the same length; the limit is finite and not negative.
/// \throws std::system_error if the system has no memory or no process left to give.
[[nodiscard]] IsolatedSolve solve_isolated(const fast::Method& method, Kind kind,
                                           std::span<const Query> queries,
                                           std::span<fast::Answer> answers,
                                           const fast::MethodOptions& method_options,
                                           const IsolationOptions& options = {});

}  // namespace touchstone::verify

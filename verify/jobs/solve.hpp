#pragma once

/// \file
/// A solver's answers to all queries of a source, in their order; nothing is judged.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/data/query_source.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

struct SolveOptions {
  /// Minimum separation.
  Separation separation = {};
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// Called for every query with its index and, where more is known of it than the answer shows,
  /// its failure (else null); in order, never from two threads at once.
  std::function<void(std::uint64_t, const fast::Answer&, const judge::Failure*)> on_answer =
      nullptr;
  /// Called now and then with the fraction of the source that is done; never from two threads at
  /// once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further queries are read and the result is that of those answered so far.
  const std::atomic<bool>* stop = nullptr;
};

/// Counts of a solver's answers by verdict, and their time.
struct SolveResult {
  std::uint64_t queries = 0;  ///< answered
  std::uint64_t yes = 0;
  std::uint64_t no = 0;
  std::uint64_t undecided = 0;
  /// Queries that were not asked (judge::Unasked): they are in no other count, nor handed out.
  std::uint64_t unasked = 0;
  std::uint64_t errors = 0;  ///< answers that are errors, or yes with times that are not finite
  /// Queries without an answer by their failure (verify/judge/fault.hpp): undecided ones and
  /// errors.
  std::array<std::uint64_t, judge::fault_count> failures{};
  /// Processes that the solver ended at no particular query: see solver_process.hpp.
  std::uint64_t unplaced_crashes = 0;
  double nanoseconds = 0.0;   ///< processor time of the solver, summed over the queries
  std::uint64_t skipped = 0;  ///< queries in error, left out
  std::uint64_t rounded = 0;  ///< coordinates rounded to double
  /// The error that ended the reading before the source's end; all of the above holds up to there.
  std::optional<std::string> reading_error = std::nullopt;
  bool interrupted = false;

  /// Mean time of the solver; 0 if there are no queries.
  [[nodiscard]] double nanoseconds_per_query() const;

  /// Adds the counts of another source.
  SolveResult& operator+=(const SolveResult& other);
};

/// Has every query of the source answered. Errors of the source end up in the result.
/// \pre the solver has an answer to every query: it is not recorded.
[[nodiscard]] SolveResult solve(data::QuerySource& source, const solvers::Solver& solver,
                                const SolveOptions& options = {});

}  // namespace touchstone::verify::jobs

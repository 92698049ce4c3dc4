#pragma once

/// \file
/// A solver under test: a method in this process or in child processes, or a file of its answers.
/// Every job asks all of them in the same way.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/judge/fault.hpp"
#include "verify/judge/judge.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify::solvers {

/// Some queries, and where they come from.
struct SolveRequest {
  AnyQueries queries = {};
  /// Minimum separation. Methods take it from here, whatever their MethodOptions say.
  Separation separation = {};
  /// The key to recorded answers: the name of the source, and the queries' numbers in it.
  std::string_view source = {};
  std::span<const std::uint64_t> indices = {};
};

/// The time of a solver.
struct SolverTime {
  double processor_nanoseconds = 0.0;  ///< of all its threads
  double wall_seconds = 0.0;
};

/// A query that was not asked.
struct UnaskedQuery {
  std::size_t position = 0;
  judge::Unasked why = judge::Unasked::missing;

  friend bool operator==(const UnaskedQuery&, const UnaskedQuery&) = default;
};

/// Data that comes with the answers.
struct SolveReply {
  /// The solver's own time, without the making of child processes; empty if it is the time of the
  /// whole call in this thread.
  std::optional<SolverTime> time = std::nullopt;
  /// The queries that were not asked, by ascending position.
  std::vector<UnaskedQuery> unasked = {};
  /// Failures that the answers themselves do not show, by ascending position. Other failures are
  /// found by judge::failure_of().
  std::vector<judge::QueryFailure> failures = {};
  /// Processes that it ended at no particular query: see solver_process.hpp.
  std::uint64_t unplaced_crashes = 0;
  /// True if it was stopped: the answers are incomplete.
  bool stopped = false;

  /// The reason why the query at a position was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t position) const;
};

/// Answers queries. Safe to use from several threads at once.
class Solver {
 public:
  explicit Solver(const fast::MethodInfo& info);
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  Solver(Solver&&) = delete;
  Solver& operator=(Solver&&) = delete;
  virtual ~Solver() = default;

  /// The description of its method, under its own name and promise.
  [[nodiscard]] const fast::MethodInfo& info() const { return info_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  void rename(std::string name);
  /// The promise its answers are judged by: its own unless hold_to() sets another.
  [[nodiscard]] fast::Promise promise() const { return info_.promise; }
  void hold_to(fast::Promise promise) { info_.promise = promise; }
  [[nodiscard]] const fast::Terms& terms() const { return info_.terms; }
  [[nodiscard]] judge::Standard standard() const { return judge::standard_of(info_); }

  /// True if its processor time is known.
  [[nodiscard]] virtual bool is_timed() const { return true; }

  /// Answers query i in answers[i], in this thread or in a child process that it waits for. Queries
  /// outside the terms of its promise are not asked, and the others in the form that the terms
  /// name.
  /// \pre as many answers as queries.
  [[nodiscard]] SolveReply solve(const SolveRequest& request,
                                 std::span<fast::Answer> answers) const;

  /// Sets the wall-clock seconds that it may take from now on, in all threads together. After that
  /// no query is begun, and the rest is skipped. Infinite: no limit.
  void allow(double seconds) const { allowance_ = seconds; }
  /// The seconds that are left; below 0 if the latest query took longer.
  [[nodiscard]] double allowance() const { return allowance_; }

  /// The same, with the time in any case; the processor time is 0 where it is not known.
  [[nodiscard]] SolveReply solve_timed(const SolveRequest& request,
                                       std::span<fast::Answer> answers) const;

  /// The output of its child processes since the last call, which clears it. Not to be called
  /// while another thread is in solve().
  [[nodiscard]] virtual CapturedOutput take_output() const { return {}; }

 private:
  /// solve() for queries within the terms, as they are. \pre as solve()
  [[nodiscard]] virtual SolveReply answer(const SolveRequest& request,
                                          std::span<fast::Answer> answers) const = 0;
  [[nodiscard]] SolveReply answer_in_time(const SolveRequest& request,
                                          std::span<fast::Answer> answers) const;

  std::string name_;
  fast::MethodInfo info_;
  mutable std::atomic<double> allowance_ = std::numeric_limits<double>::infinity();
};

/// A method in this process. A query where it throws an exception is answered Verdict::error.
/// The method must live as long as the solver, here and below.
[[nodiscard]] std::unique_ptr<Solver> solver_in_process(const fast::Method& method,
                                                        const fast::MethodOptions& options);

/// A method in child processes, one for each thread that asks at the same time. A crash or a hang
/// costs one query, which is not asked again; hangs have the limits of hang_limits.hpp, a kind of
/// one source being a sort.
[[nodiscard]] std::unique_ptr<Solver> solver_in_children(const fast::Method& method,
                                                         const fast::MethodOptions& options,
                                                         const SolverProcessOptions& process);

/// Recorded answers, looked up by source, kind and index; with terms in doubles, of all shapes.
/// They promise nothing.
[[nodiscard]] std::unique_ptr<Solver> recorded_solver(std::string_view name,
                                                      const RecordedAnswers& answers,
                                                      const fast::Terms& terms = {});

}  // namespace touchstone::verify::solvers

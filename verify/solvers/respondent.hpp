#pragma once

/// \file
/// Whoever answers queries: a method in this process, a method in a child process, or a file of
/// answers. The judge and `touchstone solve` ask all of them in the same way.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exact/query.hpp"
#include "fast/method.hpp"
#include "verify/judge/claimed_distance.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/failure.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify {

/// Some queries of one source, with their numbers in it.
struct Questions {
  const std::string& source;
  Kind kind;
  std::span<const Query> queries;
  std::span<const std::uint64_t> indices;
  /// What counts as contact. Methods take it from here, whatever their MethodOptions say.
  Separation separation = {};
};

/// What came with the answers.
struct Response {
  double nanoseconds = 0.0;  ///< processor time; 0 where it is unknown
  /// Wall-clock seconds of the solver alone, where that is less than all of it.
  std::optional<double> seconds = std::nullopt;
  /// Positions in the span of the queries without an answer, ascending.
  std::vector<std::size_t> missing = {};
  /// Of queries without an answer, ascending, where more is known than the answers show: those
  /// without a failure here may have one that failure_of() tells of.
  std::vector<QueryFailure> failures = {};
  /// Processes that it ended at no particular query: see solver_process.hpp.
  std::uint64_t unplaced_crashes = 0;
  /// Was it stopped? The answers are then no answers.
  bool stopped = false;
};

/// Answers queries. Safe to use from several threads at once.
class Respondent {
 public:
  /// \param timed Is its processor time known?
  Respondent(std::string name, fast::Promise promise, bool timed);
  Respondent(const Respondent&) = delete;
  Respondent& operator=(const Respondent&) = delete;
  Respondent(Respondent&&) = delete;
  Respondent& operator=(Respondent&&) = delete;
  virtual ~Respondent() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Gives it another name.
  void call(std::string name) { name_ = std::move(name); }
  /// What its answers are held to: its own promise unless hold_to() says otherwise.
  [[nodiscard]] fast::Promise promise() const { return promise_; }
  void hold_to(fast::Promise promise) { promise_ = promise; }
  [[nodiscard]] bool timed() const { return timed_; }
  /// What its tolerances claim.
  [[nodiscard]] const Reach& reach() const { return reach_; }
  void set_reach(Reach reach) { reach_ = std::move(reach); }

  /// Answers query i in answers[i], in this thread.
  /// \pre all spans have the same length.
  [[nodiscard]] Response answer(const Questions& questions, std::span<fast::Answer> answers) const;

  /// How many queries to ask at once, by the pace of the latest answers: as many as take some
  /// milliseconds. Few for slow solvers, so that all cores have work and an interrupt costs little;
  /// many for fast ones, so that neither clock nor child process shows in the time. The making of
  /// child processes is no part of the pace.
  [[nodiscard]] std::size_t good_span() const;

  /// What it printed, where that is caught. Not to be called while another thread is in answer().
  [[nodiscard]] virtual CapturedOutput output() const { return {}; }

 private:
  [[nodiscard]] virtual Response solve(const Questions& questions,
                                       std::span<fast::Answer> answers) const = 0;

  std::string name_;
  fast::Promise promise_;
  bool timed_;
  Reach reach_ = stated_reach;
  /// Wall-clock seconds a query, of the latest span; a guess before there is one.
  mutable std::atomic<double> pace_ = 1.0;
};

/// A method in this process. A query it throws an exception at is answered Verdict::error. The time
/// is the processor time of a whole span, the queries still being in the cache from their reading.
/// The method must live as long as the respondent, here and below.
[[nodiscard]] std::unique_ptr<Respondent> respond_in_process(const fast::Method& method,
                                                             const fast::MethodOptions& options);

/// A method in child processes, one for each thread that asks at the same time.
[[nodiscard]] std::unique_ptr<Respondent> respond_isolated(const fast::Method& method,
                                                           const fast::MethodOptions& options,
                                                           const SolverProcessOptions& process);

/// Recorded answers, looked up by source, kind and index. They promise nothing.
[[nodiscard]] std::unique_ptr<Respondent> respond_recorded(std::string name,
                                                           const RecordedAnswers& answers);

}  // namespace touchstone::verify

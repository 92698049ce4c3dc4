#pragma once

/// \file
/// The time that a solver takes for queries of a group.
///
/// **Sample.** A solver is timed on an evenly spread sample of the group, which grows until it
/// takes about as long as it may, or has all queries. Its size is sixteen times a power of two, or
/// that of the group; smaller samples are part of larger ones, and a repeated choice gives the same
/// sample.
///
/// **Time.** A repetition is one call for the whole sample, or the mean of several if one is short.
/// Its time is processor time: of the calling thread, or of the child process that it waits for.
/// Single queries are timed by the wall clock, one call each; the shortest of up to three sweeps
/// over them leaves out other work of the machine.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/data/query_group.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

/// Evenly spread queries of a group.
struct Sample {
  /// In the group, ascending.
  std::vector<std::size_t> positions;
  /// Copies of the queries there, if these are not all.
  std::vector<double> copies;
  AnyQueries queries;
};

/// The sample of this number of queries of a group, or of all there are. It is valid as long as the
/// group is.
[[nodiscard]] std::shared_ptr<const Sample> sample_of(const data::QueryGroup& group,
                                                      std::size_t count);

/// A solver, the sample of a group that it is timed on, its answers and its times.
class TimedSolver {
 public:
  /// Solver and group must live as long as this object. Its sample is empty.
  TimedSolver(const solvers::Solver& solver, const data::QueryGroup& group,
              const Separation& separation);
  TimedSolver(const TimedSolver&) = delete;
  TimedSolver& operator=(const TimedSolver&) = delete;
  TimedSolver(TimedSolver&&) = default;
  TimedSolver& operator=(TimedSolver&&) = default;
  ~TimedSolver() = default;

  /// Takes a sample of the group.
  void take(std::shared_ptr<const Sample> sample);
  /// Solves larger and larger samples, and keeps the last one.
  /// \param seconds Processor time that one call for the sample may take; positive.
  /// \param stop May be null. Once true, the sample grows no more.
  void choose_sample(double seconds, const std::atomic<bool>* stop);
  /// Times the sample once more.
  void repeat();
  /// Nanoseconds of each of `count` queries that are evenly spread over the sample, each solved
  /// alone, without the clock's own cost; infinite if it was not asked. After `seconds` no further
  /// sweep is begun. Nothing once *stop is true (it may be null).
  [[nodiscard]] std::optional<std::vector<double>> time_singles(
      std::size_t count, double seconds, const std::atomic<bool>* stop) const;
  /// Judges the latest answers to those queries whose truth is given, by their positions in the
  /// group.
  /// \pre the truths are in the order of their positions.
  [[nodiscard]] judge::Judgement judge(std::span<const judge::GroundTruth> truths) const;

  [[nodiscard]] const solvers::Solver& solver() const { return *solver_; }
  [[nodiscard]] const std::shared_ptr<const Sample>& sample() const { return sample_; }
  [[nodiscard]] const AnyQueries& queries() const { return sample_->queries; }
  /// The positions of the sample in the group, ascending.
  [[nodiscard]] const std::vector<std::size_t>& positions() const { return sample_->positions; }
  /// The answers of the latest call, query by query.
  [[nodiscard]] std::span<const fast::Answer> answers() const { return answers_; }
  /// The reason why the query at a position of the sample was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t i) const {
    return reply_.why_unasked(i);
  }
  /// Nanoseconds a query, one number for each repetition.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }

 private:
  /// Processor time in nanoseconds, the mean of this number of calls.
  double time_calls(std::size_t calls);
  /// Queries of the latest call that were asked, at least 1.
  [[nodiscard]] double asked() const;
  /// The factor by which a sample may grow within these seconds, at the pace of these queries.
  double possible_growth(double seconds);

  const solvers::Solver* solver_;
  const data::QueryGroup* group_;
  Separation separation_;
  std::shared_ptr<const Sample> sample_ = std::make_shared<Sample>();
  std::vector<fast::Answer> answers_;
  /// The reply to the latest call.
  solvers::SolveReply reply_;
  /// Crashes of all calls at no particular query.
  std::uint64_t unplaced_crashes_ = 0;
  /// Calls in a repetition; 0: not known yet.
  std::size_t calls_ = 0;
  std::vector<double> times_;
};

/// True if a solver with these terms takes such curves, in queries of whatever kind; no other is
/// timed on them.
[[nodiscard]] bool takes_curves(const fast::Terms& terms, AnyShape shape);

/// The number of times that work of this duration is to be done between two readings of the clock,
/// so that the clock's own cost does not show.
[[nodiscard]] std::size_t calls_for(double nanoseconds);

/// Processor time of the work in this thread in nanoseconds, as the mean of this number of calls.
template <class Work>
[[nodiscard]] double time_of(std::size_t calls, const Work& work) {
  const double start = base::thread_nanoseconds();
  for (std::size_t i = 0; i < calls; ++i) work();
  return (base::thread_nanoseconds() - start) / static_cast<double>(calls);
}

/// Nanoseconds between two readings of the clock that single queries are timed with, the median of
/// many; they are subtracted from the times of queries.
[[nodiscard]] double clock_nanoseconds();

// Statistics, and representative samples.

/// The middle value, of an even count the mean of the two in the middle; NaN if there are none.
[[nodiscard]] double median(std::vector<double> values);

/// The least value that at least `fraction` (0 to 1) of all do not exceed; NaN if there are none.
[[nodiscard]] double quantile(std::vector<double> values, double fraction);

/// `count` of the positions 0 … size−1, all if there are no more, ascending and evenly spread.
/// Always the same ones, and those of a smaller count are among them. They are the first multiples,
/// modulo the size, of a stride near the golden section of it: unlike every n-th position they are
/// independent of any order of the queries.
[[nodiscard]] std::vector<std::size_t> spread_sample(std::size_t size, std::size_t count);

}  // namespace touchstone::verify::jobs

#pragma once

/// \file
/// The measuring engine of benchmarks and reports: the time that a solver takes for queries of a
/// group.
///
/// **Sample.** A solver is timed on an evenly spread sample of the group, which grows until it
/// takes about as long as it may, or has all queries that may be asked. Its size is sixteen times a
/// power of two, or that of the group; smaller samples are part of larger ones, and a repeated
/// choice gives the same sample.
///
/// **Time.** A repetition is one call for the whole sample, or the mean of several if one is short.
/// Its time is processor time: of the calling thread, or of the child process that it waits for.
/// The repetitions of several solvers are to be interleaved (order_of_repetition). Single queries
/// are timed by the wall clock, one call each; the shortest of up to three sweeps over them leaves
/// out other work of the machine.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/data/query_group.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

/// Nanoseconds a query, one number for each repetition.
struct TimesPerQuery {
  std::vector<double> repetitions;

  /// NaN if there was no repetition; the same below.
  [[nodiscard]] double median() const;
  [[nodiscard]] double min() const;
};

/// Limits of a sample's size.
struct SampleLimits {
  /// Queries; at least 1.
  std::size_t most = 0;
  /// Processor time that one call for the sample may take; positive.
  double seconds = 0.0;
  /// A solver that is timed on the same sample, and may take no longer; may be null.
  const solvers::Solver* companion = nullptr;
  /// May be null. Once true, the sample grows no more.
  const std::atomic<bool>* stop = nullptr;
};

/// Evenly spread queries of a group.
struct Sample {
  /// In the group, ascending.
  std::vector<std::size_t> positions;
  /// Copies of the queries there, if these are not all.
  std::vector<double> copies;
  Queries queries;
};

/// The samples of a group. One that several solvers are timed on is in memory once.
class Samples {
 public:
  /// The group must live as long as this and as its samples.
  explicit Samples(const data::QueryGroup& group) : group_(&group) {}

  /// The sample of this number of queries, or of all there are.
  [[nodiscard]] std::shared_ptr<const Sample> of(std::size_t count);
  [[nodiscard]] const data::QueryGroup& group() const { return *group_; }

 private:
  const data::QueryGroup* group_;
  /// Those in use, by their size.
  std::map<std::size_t, std::weak_ptr<const Sample>> samples_;
};

/// A solver, the sample of a group that it is timed on, its answers and its times.
class TimedSolver {
 public:
  /// Solver and samples must live as long as this object. Its sample is empty.
  TimedSolver(const solvers::Solver& solver, Samples& samples, const Separation& separation);
  TimedSolver(const TimedSolver&) = delete;
  TimedSolver& operator=(const TimedSolver&) = delete;
  TimedSolver(TimedSolver&&) = default;
  TimedSolver& operator=(TimedSolver&&) = default;
  ~TimedSolver() = default;

  /// Takes the evenly spread sample of this number of queries, or all there are.
  void take(std::size_t count);
  /// Solves larger and larger samples, and keeps the last one.
  void choose_sample(const SampleLimits& limits);
  /// Times the sample once more, unless the solver may take no more time (Solver::allow).
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
  [[nodiscard]] const Separation& separation() const { return separation_; }
  /// The sample.
  [[nodiscard]] const Queries& queries() const { return sample_->queries; }
  /// The positions of the sample in the group, ascending.
  [[nodiscard]] const std::vector<std::size_t>& positions() const { return sample_->positions; }
  /// The answers of the latest call, query by query.
  [[nodiscard]] std::span<const fast::Answer> answers() const { return answers_; }
  /// The reason why the query at a position of the sample was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t i) const {
    return reply_.why_unasked(i);
  }
  [[nodiscard]] const TimesPerQuery& times() const { return times_; }
  /// Processor time of all repetitions.
  [[nodiscard]] double seconds_spent() const { return seconds_spent_; }

 private:
  /// Processor time in nanoseconds, the mean of this number of calls.
  double time_calls(const solvers::Solver& solver, std::size_t calls);
  /// Queries of the latest call that were asked, at least 1.
  [[nodiscard]] double asked() const;
  /// The factor by which a sample may grow within the time allowed, at the pace of these queries.
  double possible_growth(const SampleLimits& limits);

  const solvers::Solver* solver_;
  Samples* samples_;
  Separation separation_;
  std::shared_ptr<const Sample> sample_ = std::make_shared<Sample>();
  std::vector<fast::Answer> answers_;
  /// The reply to the latest call.
  solvers::SolveReply reply_;
  /// Crashes of all calls at no particular query.
  std::uint64_t unplaced_crashes_ = 0;
  /// Calls in a repetition; 0: not known yet.
  std::size_t calls_ = 0;
  TimesPerQuery times_;
  double latest_ = 0.0;  ///< nanoseconds of the latest call
  double seconds_spent_ = 0.0;
};

/// True if a solver with these terms takes such curves, in queries of whatever kind; no other is
/// timed on them.
[[nodiscard]] bool takes_curves(const fast::Terms& terms, QueryShape shape);

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

/// The order of measurements in a repetition: a rotation of 0, …, `items`−1, so that no item always
/// runs behind the same other one.
[[nodiscard]] std::vector<std::size_t> order_of_repetition(std::size_t items,
                                                           std::size_t repetition);

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

#include "verify/jobs/bench.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "verify/base/deadline.hpp"
#include "verify/jobs/memory_pass.hpp"
#include "verify/jobs/timing.hpp"

namespace touchstone::verify::jobs {
namespace {

/// One row, with a function for each part.
class Measuring {
 public:
  Measuring(const data::QueryGroup& group, const BenchOptions& options,
            judge::GroundTruthCache& truths, const solvers::Solver& solver,
            const solvers::Solver& certified, const fast::MethodOptions& asked)
      : group_(group),
        options_(options),
        truths_(truths),
        timed_(solver, group, asked.separation),
        certified_(certified, group, asked.separation) {
    row_.source = group.name();
    row_.kind = group.kind();
    row_.method = solver.name();
    row_.promise = solver.promise();
    row_.options = asked;
    row_.queries = group.queries().size();
  }

  [[nodiscard]] BenchRow row() {
    timed_.choose_sample(options_.seconds, options_.stop);
    certified_.take(timed_.sample());
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      repeat(i);
      tell(0.1 + 0.4 * static_cast<double>(i + 1) / static_cast<double>(options_.repetitions));
    }
    describe();
    if (!stopped()) judge();
    tell(0.9);
    if (options_.singles != 0 && !stopped()) row_.singles = singles();
    tell(1.0);
    row_.interrupted = stopped();
    return row_;
  }

 private:
  [[nodiscard]] bool stopped() const { return base::is_stopped(options_.stop); }

  void tell(double fraction) const {
    if (options_.on_progress) options_.on_progress(fraction);
  }

  /// In turns that rotate, so that none always runs behind the same other one.
  void repeat(std::size_t repetition) {
    for (std::size_t i = 0; i < 3 && !stopped(); ++i) {
      switch ((i + repetition) % 3) {
        case 0:
          pass_over_memory();
          break;
        case 1:
          certified_.repeat();
          break;
        default:
          timed_.repeat();
      }
    }
  }

  void pass_over_memory() {
    const auto pass = [this] { checksum_ = checksum_ ^ memory_pass(group_.queries().numbers); };
    if (pass_calls_ == 0) pass_calls_ = calls_for(time_of(1, pass));
    passes_.push_back(time_of(pass_calls_, pass) / static_cast<double>(row_.queries));
  }

  void describe() {
    row_.timed = timed_.queries().size();
    row_.nanoseconds = median(timed_.times());
    row_.certified_nanoseconds = median(certified_.times());
    row_.pass_nanoseconds = median(passes_);
    const std::int64_t limit = row_.options.max_checks;
    for (std::size_t i = 0; i < row_.timed; ++i) {
      if (timed_.why_unasked(i)) continue;
      const fast::Answer& answer = timed_.answers()[i];
      const bool is_spent = limit > 0 && std::int64_t{answer.checks} >= limit;
      row_.at_limit += is_spent || answer.verdict == fast::Verdict::undecided ? 1U : 0U;
    }
  }

  // ---- Judging ----------------------------------------------------------------------------------

  /// The positions in the sample of queries that are not called free.
  [[nodiscard]] std::vector<std::size_t> called_collisions() const {
    std::vector<std::size_t> called;
    for (std::size_t i = 0; i < row_.timed; ++i) {
      const auto is_no = [i](const TimedSolver& by) {
        return by.answers()[i].verdict == fast::Verdict::no;
      };
      if (!is_no(timed_) || !is_no(certified_)) called.push_back(i);
    }
    std::vector<std::size_t> chosen = spread_sample(called.size(), options_.judge);
    for (std::size_t& position : chosen) position = called[position];
    return chosen;
  }

  /// The positions in the group of the queries to judge.
  [[nodiscard]] std::vector<std::size_t> positions_to_judge() const {
    std::vector<std::size_t> chosen = spread_sample(row_.timed, options_.judge), all;
    std::ranges::set_union(chosen, called_collisions(), std::back_inserter(all));
    for (std::size_t& position : all) position = timed_.positions()[position];
    return all;
  }

  void judge() {
    row_.judgement =
        timed_.judge(truths_.of(row_.options.separation, positions_to_judge(), options_.stop,
                                [this](double part) { tell(0.5 + 0.4 * part); }));
  }

  // ---- Single queries ---------------------------------------------------------------------------

  [[nodiscard]] std::optional<SingleTimes> singles() const {
    auto times = timed_.time_singles(options_.singles, options_.seconds, options_.stop);
    if (times) std::erase_if(*times, [](double time) { return std::isinf(time); });
    if (!times || times->empty()) return std::nullopt;
    const double sum = std::accumulate(times->begin(), times->end(), 0.0);
    return SingleTimes{.mean = sum / static_cast<double>(times->size()),
                       .p50 = quantile(*times, 0.5),
                       .p99 = quantile(*times, 0.99)};
  }

  const data::QueryGroup& group_;
  const BenchOptions& options_;
  judge::GroundTruthCache& truths_;
  TimedSolver timed_;
  TimedSolver certified_;
  BenchRow row_;
  std::vector<double> passes_;
  std::size_t pass_calls_ = 0;
  /// Receives the result of the memory pass.
  volatile std::uint64_t checksum_ = 0;
};

}  // namespace

bool broke_promise(const BenchRow& row) {
  return row.promise != fast::Promise::none && !judge::keeps(row.judgement, row.promise);
}

Bench::Bench(const data::QueryGroup& group, const BenchOptions& options)
    : group_(group),
      options_(options),
      truths_(group, options.threads),
      certified_(fast::certified_method()) {
  if (group.queries().empty()) throw std::invalid_argument(group.name() + ": no queries");
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  if (!(options.seconds > 0.0)) throw std::invalid_argument("seconds must be positive");
}

BenchRow Bench::row(const solvers::Solver& solver, const fast::MethodOptions& asked) {
  const auto certified = solvers::solver_in_process(*certified_, {});
  return Measuring(group_, options_, truths_, solver, *certified, asked).row();
}

}  // namespace touchstone::verify::jobs

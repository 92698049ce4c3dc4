#include "verify/jobs/bench.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "verify/base/deadline.hpp"
#include "verify/jobs/memory_pass.hpp"
#include "verify/jobs/timing.hpp"
#include "verify/judge/ground_truth_cache.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The completed fraction of the work, in steps of about equal duration.
class Steps {
 public:
  Steps(std::size_t steps, const std::function<void(double)>& tell)
      : steps_(static_cast<double>(steps)), tell_(tell) {}

  void done(double part_of_next = 0.0) const {
    if (tell_) tell_((done_ + part_of_next) / steps_);
  }
  void next(std::size_t steps = 1) {
    done_ += static_cast<double>(steps);
    done();
  }

 private:
  double steps_;
  double done_ = 0.0;
  const std::function<void(double)>& tell_;
};

/// One run, with a function for each part.
class BenchRun {
 public:
  BenchRun(const data::QueryGroup& group, std::span<const solvers::Solver* const> solvers,
           const BenchOptions& options)
      : group_(group),
        samples_(group),
        options_(options),
        truths_(group, options.threads),
        steps_((options.repetitions + 3) * solvers.size() + options.repetitions,
               options.on_progress) {
    result_.name = group.name();
    result_.kind = group.kind();
    result_.separation = options.separation;
    result_.queries = group.queries().size();
    for (const solvers::Solver* solver : solvers)
      timed_.emplace_back(*solver, samples_, options.separation);
  }

  [[nodiscard]] BenchResult result() {
    for (TimedSolver& timed : timed_) {
      if (!stopped()) {
        timed.choose_sample(
            {.most = group_.queries().size(), .seconds = options_.seconds, .stop = options_.stop});
      }
      steps_.next();
    }
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) repeat(i);
    report();
    judge();
    time_singles();
    result_.interrupted = stopped();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool stopped() const { return base::is_stopped(options_.stop); }

  void repeat(std::size_t repetition) {
    for (const std::size_t item : order_of_repetition(timed_.size() + 1, repetition)) {
      if (stopped()) return;
      if (item == 0) {
        pass_over_memory();
      } else {
        timed_[item - 1].repeat();
      }
      steps_.next();
    }
  }

  void pass_over_memory() {
    const auto pass = [this] { checksum_ = checksum_ ^ memory_pass(group_.queries().numbers); };
    if (pass_calls_ == 0) pass_calls_ = calls_for(time_of(1, pass));
    const double time = time_of(pass_calls_, pass);
    result_.memory_pass.repetitions.push_back(time / static_cast<double>(result_.queries));
  }

  void report() {
    for (const TimedSolver& timed : timed_) {
      SolverResult& said = result_.solvers.emplace_back();
      said.name = timed.solver().name();
      said.promise = timed.solver().promise();
      said.queries = timed.queries().size();
      said.times = timed.times();
      if (!stopped()) said.stages = solvers::count_stages(timed.solver().info(), timed.answers());
    }
  }

  // ---- Judging ----------------------------------------------------------------------------------

  /// Queries for which some solver's answer is not no, at most as many as the judged sample.
  [[nodiscard]] std::vector<std::size_t> called_collisions() const {
    std::vector<bool> is_called(result_.queries);
    for (const TimedSolver& timed : timed_) {
      for (std::size_t i = 0; i < timed.queries().size(); ++i) {
        if (timed.answers()[i].verdict == fast::Verdict::no) continue;
        is_called[timed.positions()[i]] = true;
      }
    }
    std::vector<std::size_t> called;
    for (std::size_t i = 0; i < is_called.size(); ++i) {
      if (is_called[i]) called.push_back(i);
    }
    std::vector<std::size_t> chosen = spread_sample(called.size(), options_.judge);
    for (std::size_t& position : chosen) position = called[position];
    return chosen;
  }

  [[nodiscard]] std::vector<std::size_t> positions_to_judge() const {
    std::vector<std::size_t> sample = spread_sample(result_.queries, options_.judge);
    if (sample.size() == result_.queries) return sample;
    std::vector<std::size_t> both;
    std::ranges::set_union(sample, called_collisions(), std::back_inserter(both));
    return both;
  }

  void judge() {
    if (stopped()) return;
    const auto on_progress = [this](double part) {
      steps_.done(part * static_cast<double>(timed_.size()));
    };
    const std::vector<judge::GroundTruth> truths =
        truths_.of(options_.separation, positions_to_judge(), options_.stop, on_progress);
    steps_.next(timed_.size());
    result_.judged = truths.size();
    result_.collisions =
        static_cast<std::size_t>(std::ranges::count_if(truths, &judge::GroundTruth::collides));
    for (std::size_t i = 0; i < timed_.size(); ++i) {
      SolverResult& said = result_.solvers[i];
      said.judgement = timed_[i].judge(truths);
      for (const judge::WrongAnswer& wrong : said.judgement.wrong_answers) {
        said.wrong_places.push_back(group_.place_of(wrong.index));
      }
    }
  }

  // ---- Single queries ---------------------------------------------------------------------------

  void time_singles() {
    for (std::size_t i = 0; i < timed_.size(); ++i) {
      if (stopped()) return;
      if (!timed_[i].solver().only_as_a_whole()) result_.solvers[i].singles = singles_of(timed_[i]);
      steps_.next();
    }
  }

  [[nodiscard]] std::optional<SingleTimes> singles_of(const TimedSolver& timed) const {
    auto times = timed.time_singles(options_.singles, options_.seconds, options_.stop);
    if (times) std::erase_if(*times, [](double time) { return std::isinf(time); });
    if (!times || times->empty()) return std::nullopt;
    const double sum = std::accumulate(times->begin(), times->end(), 0.0);
    return SingleTimes{.queries = times->size(),
                       .mean = sum / static_cast<double>(times->size()),
                       .p50 = quantile(*times, 0.5),
                       .p99 = quantile(*times, 0.99),
                       .max = quantile(*times, 1.0)};
  }

  const data::QueryGroup& group_;
  Samples samples_;
  const BenchOptions& options_;
  std::vector<TimedSolver> timed_;
  judge::GroundTruthCache truths_;
  Steps steps_;
  BenchResult result_;
  std::size_t pass_calls_ = 0;
  /// Receives the result of the memory pass.
  volatile std::uint64_t checksum_ = 0;
};

}  // namespace

bool broke_promise(const SolverResult& result) {
  return result.promise != fast::Promise::none && !judge::keeps(result.judgement, result.promise);
}

bool any_broke_promise(std::span<const BenchResult> results) {
  return std::ranges::any_of(results, [](const BenchResult& result) {
    return std::ranges::any_of(result.solvers, broke_promise);
  });
}

BenchResult bench(const data::QueryGroup& group, std::span<const solvers::Solver* const> solvers,
                  const BenchOptions& options) {
  if (group.queries().empty()) throw std::invalid_argument(group.name() + ": no queries");
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  if (!(options.seconds > 0.0)) throw std::invalid_argument("seconds must be positive");
  return BenchRun(group, solvers, options).result();
}

}  // namespace touchstone::verify::jobs

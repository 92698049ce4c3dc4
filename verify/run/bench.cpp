#include "verify/run/bench.hpp"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "verify/judge/ground_truth.hpp"
#include "verify/run/memory_pass.hpp"
#include "verify/run/statistics.hpp"
#include "verify/run/thread_clock.hpp"

namespace touchstone::verify {
namespace {

namespace tbb = oneapi::tbb;
using Clock = std::chrono::steady_clock;

/// Shorter work is done several times at once, so that the clock does not show.
constexpr double least_nanoseconds = 2e6;
/// The first guess at a contender's pace is made on so many queries, the next on at most so many
/// times as many.
constexpr std::size_t first_guess = 16;
constexpr double most_growth = 64.0;
/// Queries decided between two looks at `stop`.
constexpr std::size_t judging_step = 4096;
constexpr unsigned most_threads = 1024;
constexpr int sweeps = 3;
constexpr int clock_readings = 10'000;

double nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

/// Processor time of the work, as the mean of so many rounds.
template <class Work>
double time_of(std::size_t rounds, const Work& work) {
  const double start = thread_nanoseconds();
  for (std::size_t i = 0; i < rounds; ++i) work();
  return (thread_nanoseconds() - start) / static_cast<double>(rounds);
}

/// Processor time of a contender on these queries, as the mean of so many rounds.
double time_of(std::size_t rounds, Contender& contender, Kind kind,
               std::span<const Query> queries) {
  double elsewhere = 0.0;
  const double here = time_of(rounds, [&] {
    contender.solve(kind, queries);
    elsewhere += contender.nanoseconds_elsewhere().value_or(0.0);
  });
  const bool is_elsewhere = contender.nanoseconds_elsewhere().has_value();
  return is_elsewhere ? elsewhere / static_cast<double>(rounds) : here;
}

std::size_t rounds_for(double nanoseconds) {
  return static_cast<std::size_t>(std::clamp(least_nanoseconds / nanoseconds, 1.0, 1e6));
}

/// A contender with the queries that it is timed on.
struct Entry {
  Contender* contender = nullptr;
  /// Positions in the group, ascending; empty for all of it.
  std::vector<std::size_t> positions;
  /// Copies of the queries there.
  std::vector<Query> sample;
  std::span<const Query> queries;
  std::size_t rounds = 1;
  Times times;

  [[nodiscard]] std::size_t position(std::size_t i) const {
    return positions.empty() ? i : positions[i];
  }
};

/// Fraction of the work that is done, in steps of which all take about as long.
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

/// One run, a method for each part of it.
class Run {
 public:
  Run(const QueryGroup& group, std::span<const std::unique_ptr<Contender>> contenders,
      const BenchOptions& options)
      : group_(group),
        queries_(group.queries()),
        options_(options),
        entries_(contenders.size()),
        steps_((options.repetitions + 3) * contenders.size() + options.repetitions,
               options.on_progress) {
    result_.name = group.name();
    result_.kind = group.kind();
    result_.separation = options.separation;
    result_.queries = queries_.size();
    for (std::size_t i = 0; i < contenders.size(); ++i) entries_[i].contender = contenders[i].get();
  }

  [[nodiscard]] BenchResult result() {
    for (Entry& entry : entries_) {
      if (!stopped()) choose_queries(entry);
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
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  void take(Entry& entry, std::size_t count) const {
    entry.positions.clear();
    entry.sample.clear();
    entry.queries = queries_;
    if (count >= queries_.size()) return;
    entry.positions = spread_sample(queries_.size(), count);
    for (const std::size_t position : entry.positions) entry.sample.push_back(queries_[position]);
    entry.queries = entry.sample;
  }

  /// Solves larger and larger samples until one takes about as long as it may, or all are in it.
  /// The pace varies from query to query, so a small sample says little.
  void choose_queries(Entry& entry) const {
    std::size_t count = entry.contender->only_as_a_whole() ? queries_.size() : first_guess;
    for (;;) {
      take(entry, count);
      double growth = possible_growth(entry);
      if (entry.positions.empty() || stopped()) return;
      // The first time a sample is solved its memory is touched for the first time too.
      if (growth < 2.0) growth = possible_growth(entry);
      if (growth < 2.0 || stopped()) return;
      count = growing(count, growth);
    }
  }

  /// How many times as many queries would take as long as they may, by the pace of these.
  [[nodiscard]] double possible_growth(Entry& entry) const {
    const Clock::time_point start = Clock::now();
    double time = time_of(1, *entry.contender, group_.kind(), entry.queries);
    // A child process may sleep.
    if (entry.contender->nanoseconds_elsewhere()) time = std::max(time, nanoseconds_since(start));
    entry.rounds = rounds_for(time);
    return std::min(0.9 * 1e9 * options_.seconds / time, most_growth);
  }

  /// A power of two times the first guess, so that the same sample is found again.
  static std::size_t growing(std::size_t count, double growth) {
    return count * std::bit_floor(static_cast<std::size_t>(growth));
  }

  void repeat(std::size_t repetition) {
    for (const std::size_t item : order_of_repetition(entries_.size() + 1, repetition)) {
      if (stopped()) return;
      if (item == 0) {
        pass_over_memory();
      } else {
        time(entries_[item - 1]);
      }
      steps_.next();
    }
  }

  void pass_over_memory() {
    const auto pass = [this] { checksum_ = checksum_ ^ memory_pass(queries_); };
    if (pass_rounds_ == 0) pass_rounds_ = rounds_for(time_of(1, pass));
    const double time = time_of(pass_rounds_, pass);
    result_.memory_pass.repetitions.push_back(time / static_cast<double>(queries_.size()));
  }

  void time(Entry& entry) const {
    const double time = time_of(entry.rounds, *entry.contender, group_.kind(), entry.queries);
    entry.times.repetitions.push_back(time / static_cast<double>(entry.queries.size()));
  }

  void report() {
    for (Entry& entry : entries_) {
      ContenderResult& said = result_.contenders.emplace_back();
      said.name = entry.contender->name();
      said.promise = entry.contender->promise();
      said.queries = entry.queries.size();
      said.times = entry.times;
      if (!stopped()) said.stages = entry.contender->stages(group_.kind(), entry.queries);
    }
  }

  // ---- Judging ----------------------------------------------------------------------------------

  /// Those that some contender does not say no to, at most as many as are judged of a sample.
  [[nodiscard]] std::vector<std::size_t> called_collisions() const {
    std::vector<bool> is_called(queries_.size());
    for (const Entry& entry : entries_) {
      for (std::size_t i = 0; i < entry.queries.size(); ++i) {
        if (entry.contender->answer(i).verdict == fast::Verdict::no) continue;
        is_called[entry.position(i)] = true;
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
    std::vector<std::size_t> sample = spread_sample(queries_.size(), options_.judge);
    if (sample.size() == queries_.size()) return sample;
    std::vector<std::size_t> both;
    std::ranges::set_union(sample, called_collisions(), std::back_inserter(both));
    return both;
  }

  [[nodiscard]] Truth truth_of(std::size_t position) const {
    return verify::truth_of(position,
                            exact::decide(group_.kind(), queries_[position], options_.separation));
  }

  /// The truth of these queries, or of the first of them if stopped.
  [[nodiscard]] std::vector<Truth> decide(const std::vector<std::size_t>& positions) {
    std::vector<Truth> truths(positions.size());
    tbb::task_arena arena(options_.threads == 0
                              ? tbb::info::default_concurrency()
                              : static_cast<int>(std::min(options_.threads, most_threads)));
    const auto part_of_steps = static_cast<double>(entries_.size());
    for (std::size_t first = 0; first < positions.size(); first += judging_step) {
      if (stopped()) {
        truths.resize(first);
        break;
      }
      const std::size_t last = std::min(first + judging_step, positions.size());
      arena.execute([&] {
        tbb::parallel_for(first, last, [&](std::size_t i) { truths[i] = truth_of(positions[i]); });
      });
      steps_.done(part_of_steps * static_cast<double>(last) /
                  static_cast<double>(positions.size()));
    }
    steps_.next(entries_.size());
    return truths;
  }

  void judge() {
    if (stopped()) return;
    const std::vector<Truth> truths = decide(positions_to_judge());
    result_.judged = truths.size();
    result_.collisions = static_cast<std::size_t>(std::ranges::count_if(truths, &Truth::collides));
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      judge(entries_[i], truths, result_.contenders[i]);
    }
  }

  void judge(const Entry& entry, const std::vector<Truth>& truths, ContenderResult& said) const {
    std::size_t i = 0;
    for (const Truth& truth : truths) {
      while (i < entry.queries.size() && entry.position(i) < truth.index) ++i;
      if (i == entry.queries.size()) break;
      if (entry.position(i) != truth.index) continue;
      said.judgement.add(truth, entry.contender->answer(i), entry.contender->failure(i));
    }
    said.judgement.add_unplaced_crashes(entry.contender->unplaced_crashes());
    for (const WrongAnswer& wrong : said.judgement.wrong_answers) {
      said.wrong_places.push_back(group_.place_of(wrong.index));
    }
  }

  // ---- Single queries ---------------------------------------------------------------------------

  void time_singles() {
    const double clock = clock_nanoseconds();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (stopped()) return;
      if (!entries_[i].contender->only_as_a_whole()) {
        result_.contenders[i].singles = singles_of(entries_[i], clock);
      }
      steps_.next();
    }
  }

  [[nodiscard]] std::optional<SingleTimes> singles_of(const Entry& entry, double clock) const {
    const auto chosen = spread_sample(entry.queries.size(), options_.singles);
    if (chosen.empty()) return std::nullopt;
    std::vector<double> times(chosen.size(), std::numeric_limits<double>::infinity());
    const Clock::time_point start = Clock::now();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const auto query = entry.queries.subspan(chosen[i], 1);
        const Clock::time_point before = Clock::now();
        entry.contender->solve(group_.kind(), query);
        times[i] = std::min(
            times[i], entry.contender->nanoseconds_elsewhere().value_or(nanoseconds_since(before)));
        if (stopped()) return std::nullopt;
      }
      if (nanoseconds_since(start) > 1e9 * options_.seconds) break;
    }
    for (double& time : times) time = std::max(time - clock, 0.0);
    return SingleTimes{.queries = times.size(),
                       .p50 = quantile(times, 0.5),
                       .p99 = quantile(times, 0.99),
                       .max = quantile(times, 1.0)};
  }

  const QueryGroup& group_;
  std::span<const Query> queries_;
  const BenchOptions& options_;
  std::vector<Entry> entries_;
  Steps steps_;
  BenchResult result_;
  std::size_t pass_rounds_ = 0;
  /// Written to so that the reading has a result.
  volatile std::uint64_t checksum_ = 0;
};

}  // namespace

double Times::median() const { return verify::median(repetitions); }

double Times::min() const { return quantile(repetitions, 0.0); }

bool broke_promise(const ContenderResult& result) {
  return result.promise != fast::Promise::none && !keeps(result.judgement, result.promise);
}

bool any_broke_promise(std::span<const BenchResult> results) {
  return std::ranges::any_of(results, [](const BenchResult& result) {
    return std::ranges::any_of(result.contenders, broke_promise);
  });
}

std::vector<std::size_t> order_of_repetition(std::size_t items, std::size_t repetition) {
  std::vector<std::size_t> order(items);
  for (std::size_t i = 0; i < items; ++i) order[i] = (i + repetition) % items;
  return order;
}

double clock_nanoseconds() {
  std::vector<double> times(clock_readings);
  for (double& time : times) time = nanoseconds_since(Clock::now());
  return median(times);
}

BenchResult bench(const QueryGroup& group, std::span<const std::unique_ptr<Contender>> contenders,
                  const BenchOptions& options) {
  if (group.queries().empty()) throw std::invalid_argument(group.name() + ": no queries");
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  if (!(options.seconds > 0.0)) throw std::invalid_argument("seconds must be positive");
  return Run(group, contenders, options).result();
}

}  // namespace touchstone::verify

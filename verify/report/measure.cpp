#include "verify/report/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "verify/judge/judge.hpp"
#include "verify/run/bench.hpp"
#include "verify/run/statistics.hpp"
#include "verify/run/thread_clock.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify {
namespace {

using Clock = std::chrono::steady_clock;

/// Shorter work is done several times at once, so that the clock does not show.
constexpr double least_nanoseconds = 2e6;
constexpr std::size_t first_sample = 16;
constexpr int sweeps = 3;

double nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

/// An answer, and how long it took alone.
struct Reply {
  fast::Answer answer;
  double nanoseconds = std::numeric_limits<double>::infinity();
};

/// A solver with the queries that it is asked.
struct Entry {
  std::shared_ptr<const Solver> solver;
  Separation separation = {};
  std::vector<std::size_t> positions;  ///< in the group, ascending
  std::vector<Query> queries;          ///< copies of those there
  std::vector<fast::Answer> answers;
  std::vector<double> times;  ///< nanoseconds a query, one a repetition
  double spent = 0.0;         ///< nanoseconds in all repetitions
};

Separation separation_of(const fast::MethodOptions& options) {
  return {.distance = options.min_separation, .norm = options.norm};
}

/// What is asked of which method.
Measurement of_question(const QueryGroup& group, Experiment experiment, const Setting& setting) {
  Measurement said;
  said.experiment = experiment;
  said.group = group.name();
  said.kind = group.kind();
  said.method = setting.method->name();
  said.promise = setting.method->promise();
  said.tolerance = setting.options.tolerance;
  said.max_checks = setting.options.max_checks;
  said.separation = separation_of(setting.options);
  said.group_queries = group.queries().size();
  return said;
}

bool is_at_limit(const fast::Answer& answer, std::int64_t max_checks) {
  if (answer.verdict == fast::Verdict::undecided) return true;
  return max_checks > 0 && std::int64_t{answer.checks} >= max_checks;
}

std::optional<Spread> spread_of(const ToiErrors& numbers) {
  if (numbers.count() == 0) return std::nullopt;
  return Spread{.count = numbers.count(), .median = numbers.quantile(0.5), .max = numbers.max()};
}

void set_counts(const Judgement& judgement, Measurement& said) {
  said.false_positives = judgement.count(Fault::false_positive);
  said.false_negatives = judgement.count(Fault::false_negative);
  said.late_tois = judgement.count(Fault::late_toi);
  said.early_upper_tois = judgement.count(Fault::early_toi_upper);
  said.errors = judgement.count(Fault::error);
  said.undecided = judgement.undecided;
  said.keeps_promise = said.promise == fast::Promise::none || keeps(judgement, said.promise);
  said.toi_error = spread_of(judgement.toi_errors);
}

class Run {
 public:
  Run(const QueryGroup& group, Truths& truths, std::span<const Setting> settings,
      const fast::Method& reference, const MeasureOptions& options)
      : group_(group),
        truths_(truths),
        settings_(settings),
        reference_(solver_in_process(reference, {})),
        options_(options),
        clock_(clock_nanoseconds()) {}

  [[nodiscard]] std::vector<Measurement> measurements() {
    for (const Setting& setting : settings_) {
      ask(setting);
      tell(0.5 * static_cast<double>(entries_.size()) / static_cast<double>(settings_.size()));
    }
    if (options_.same_sample) share_samples();
    for (std::size_t i = 0; i < settings_.size(); ++i) decide(i);
    add_references();
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      repeat(i);
      tell(0.5 + 0.4 * static_cast<double>(i + 1) / static_cast<double>(options_.repetitions));
    }
    std::vector<Measurement> result;
    for (std::size_t i = 0; i < settings_.size(); ++i) {
      if (is_complete(i)) result.push_back(report(i));
    }
    tell(1.0);
    return result;
  }

 private:
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }

  void tell(double fraction) const {
    if (options_.on_progress) options_.on_progress(fraction);
  }

  // ---- Asking -----------------------------------------------------------------------------------

  /// Asks larger and larger samples until the next one would take too long, or too long for the
  /// reference, which is timed on it too.
  void ask(const Setting& setting) {
    Entry& entry = entries_.emplace_back();
    std::map<std::size_t, Reply>& replies = replies_.emplace_back();
    entry.solver = solver_in_process(*setting.method, setting.options);
    entry.separation = separation_of(setting.options);
    const std::size_t most = std::min(options_.count, group_.queries().size());
    double own = 0.0;  // seconds
    std::size_t count = std::min(first_sample, most);
    for (;;) {
      own += seconds_of([&] { sweep(entry, replies, sample(count)); });
      take(entry, count);
      const double of_reference =
          seconds_of([&] { static_cast<void>(solve(*reference_, group_.kind(), entry)); });
      const std::size_t next = std::min(2 * count, most);
      const double pace = std::max(own, of_reference) / static_cast<double>(count);
      if (next == count || stopped() || pace * static_cast<double>(next) > options_.seconds) break;
      count = next;
    }
    const double once = own;
    for (int i = 1; i < sweeps && own + once < options_.seconds && !stopped(); ++i) {
      own += seconds_of([&] { time_alone(entry, replies); });
    }
  }

  template <class Work>
  static double seconds_of(const Work& work) {
    const double start = thread_nanoseconds();
    work();
    return 1e-9 * (thread_nanoseconds() - start);
  }

  static SolveReply solve(const Solver& solver, Kind kind, Entry& entry) {
    return solver.solve({.kind = kind, .queries = entry.queries, .separation = entry.separation},
                        entry.answers);
  }

  [[nodiscard]] std::vector<std::size_t> sample(std::size_t count) const {
    return spread_sample(group_.queries().size(), count);
  }

  void take(Entry& entry, std::size_t count) const {
    entry.positions = sample(count);
    entry.queries.clear();
    for (const std::size_t position : entry.positions) {
      entry.queries.push_back(group_.queries()[position]);
    }
    entry.answers.resize(count);
  }

  /// Gives all entries of one name the smallest of their samples.
  void share_samples() {
    std::map<std::string, std::size_t> smallest;
    for (const Entry& entry : entries_) {
      const auto [size, is_new] =
          smallest.try_emplace(entry.solver->name(), entry.positions.size());
      size->second = std::min(size->second, entry.positions.size());
    }
    for (Entry& entry : entries_) take(entry, smallest.at(entry.solver->name()));
  }

  void decide(std::size_t index) {
    const Entry& entry = entries_[index];
    known_.push_back(truths_.of(entry.separation, entry.positions, options_.stop));
  }

  /// Asks those that have no reply yet.
  void sweep(const Entry& entry, std::map<std::size_t, Reply>& replies,
             const std::vector<std::size_t>& positions) const {
    for (const std::size_t position : positions) {
      if (stopped()) return;
      const auto [reply, is_new] = replies.try_emplace(position);
      if (is_new) ask_alone(entry, position, reply->second);
    }
  }

  void time_alone(const Entry& entry, std::map<std::size_t, Reply>& replies) const {
    for (auto& [position, reply] : replies) {
      if (stopped()) return;
      ask_alone(entry, position, reply);
    }
  }

  void ask_alone(const Entry& entry, std::size_t position, Reply& reply) const {
    const std::span<const Query> query(&group_.queries()[position], 1);
    const SolveRequest request{
        .kind = group_.kind(), .queries = query, .separation = entry.separation};
    const Clock::time_point before = Clock::now();
    static_cast<void>(entry.solver->solve(request, {&reply.answer, 1}));
    const double time = std::max(nanoseconds_since(before) - clock_, 0.0);
    reply.nanoseconds = std::min(reply.nanoseconds, time);
  }

  // ---- Timing -----------------------------------------------------------------------------------

  /// Which reference an entry is compared with.
  using ReferenceKey = std::tuple<std::size_t, double, Norm>;

  static ReferenceKey key_of(const Entry& entry) {
    return {entry.positions.size(), entry.separation.distance, entry.separation.norm};
  }

  /// The reference on each of the samples, at each of the separations.
  void add_references() {
    for (std::size_t i = 0; i < settings_.size(); ++i) {
      const ReferenceKey key = key_of(entries_[i]);
      if (reference_of_.contains(key)) continue;
      reference_of_[key] = entries_.size();
      Entry entry = entries_[i];
      entry.solver = reference_;
      entries_.push_back(std::move(entry));
    }
  }

  void repeat(std::size_t repetition) {
    for (const std::size_t i : order_of_repetition(entries_.size(), repetition)) {
      if (stopped()) return;
      Entry& entry = entries_[i];
      if (entry.times.empty() || entry.spent < 1e9 * options_.seconds) time(entry);
    }
  }

  void time(Entry& entry) const {
    std::size_t rounds = 0;
    const double start = thread_nanoseconds();
    double passed = 0.0;
    do {
      static_cast<void>(solve(*entry.solver, group_.kind(), entry));
      ++rounds;
      passed = thread_nanoseconds() - start;
    } while (passed < least_nanoseconds);
    entry.spent += passed;
    entry.times.push_back(passed / static_cast<double>(rounds * entry.queries.size()));
  }

  // ---- Reporting --------------------------------------------------------------------------------

  [[nodiscard]] const Entry& reference_for(const Entry& entry) const {
    return entries_[reference_of_.at(key_of(entry))];
  }

  [[nodiscard]] bool is_complete(std::size_t index) const {
    const Entry& entry = entries_[index];
    return !entry.times.empty() && !reference_for(entry).times.empty() &&
           known_[index].size() == entry.positions.size();
  }

  [[nodiscard]] Measurement report(std::size_t index) const {
    const Entry& entry = entries_[index];
    Measurement said = of_question(group_, options_.experiment, settings_[index]);
    said.asked = entry.positions.size();
    said.nanoseconds = median(entry.times);
    said.repetitions = entry.times.size();
    said.certified_nanoseconds = median(reference_for(entry).times);
    for (const StageCount& stage : count_stages(entry.solver->info(), entry.answers)) {
      said.stages.push_back({std::string(stage.stage), stage.queries});
    }
    judge(replies_[index], known_[index], said);
    return said;
  }

  static void judge(const std::map<std::size_t, Reply>& replies, const std::vector<Truth>& truths,
                    Measurement& said) {
    Judgement judgement;
    ToiErrors tolerances;
    for (const Truth& truth : truths) {
      const Reply& reply = replies.at(truth.index);
      judgement.add(truth, reply.answer);
      said.collisions += truth.collides ? 1U : 0U;
      said.at_limit += is_at_limit(reply.answer, said.max_checks) ? 1U : 0U;
      (truth.collides ? said.hit_times : said.miss_times).add(reply.nanoseconds);
      const bool is_yes = reply.answer.verdict == fast::Verdict::yes;
      if (is_yes && reply.answer.tolerance >= 0.0) tolerances.add(reply.answer.tolerance);
    }
    set_counts(judgement, said);
    said.achieved_tolerance = spread_of(tolerances);
  }

  const QueryGroup& group_;
  Truths& truths_;
  std::span<const Setting> settings_;
  std::shared_ptr<const Solver> reference_;
  const MeasureOptions& options_;
  double clock_;
  /// Of the settings in their order, then the reference on each size of sample.
  std::vector<Entry> entries_;
  /// Of the settings, by position.
  std::vector<std::map<std::size_t, Reply>> replies_;
  /// Of the settings; fewer than were asked if stopped.
  std::vector<std::vector<Truth>> known_;
  /// Where in entries_.
  std::map<ReferenceKey, std::size_t> reference_of_;
};

}  // namespace

std::vector<Measurement> measure(const QueryGroup& group, Truths& truths,
                                 std::span<const Setting> settings, const fast::Method& reference,
                                 const MeasureOptions& options) {
  if (group.queries().empty()) throw std::invalid_argument(group.name() + ": no queries");
  if (options.count == 0) throw std::invalid_argument("count must be at least 1");
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  if (!(options.seconds > 0.0)) throw std::invalid_argument("seconds must be positive");
  return Run(group, truths, settings, reference, options).measurements();
}

std::optional<Measurement> judge_all(const QueryGroup& group, Truths& truths,
                                     const fast::Method& method, const fast::MethodOptions& options,
                                     Experiment experiment, const std::atomic<bool>* stop) {
  const std::vector<Query>& queries = group.queries();
  std::vector<std::size_t> positions(queries.size());
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  const std::vector<Truth> known = truths.of(separation_of(options), positions, stop);
  if (known.size() < queries.size()) return std::nullopt;
  std::vector<fast::Answer> answers(queries.size());
  method.solve(group.kind(), queries, answers, options);
  Measurement said = of_question(group, experiment, {.method = &method, .options = options});
  said.asked = queries.size();
  Judgement judgement;
  for (const Truth& truth : known) {
    judgement.add(truth, answers[truth.index]);
    said.collisions += truth.collides ? 1U : 0U;
    said.at_limit += is_at_limit(answers[truth.index], said.max_checks) ? 1U : 0U;
  }
  set_counts(judgement, said);
  return said;
}

}  // namespace touchstone::verify

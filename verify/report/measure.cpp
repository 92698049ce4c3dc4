#include "verify/report/measure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "verify/base/deadline.hpp"
#include "verify/jobs/timing.hpp"
#include "verify/report/judgement_report.hpp"

namespace touchstone::verify::report {
namespace {

/// The method, and the options of the call.
Measurement of_separation(const data::QueryGroup& group, Experiment experiment,
                          const Setting& setting) {
  Measurement said;
  said.experiment = experiment;
  said.group = group.name();
  said.kind = group.kind();
  said.method = setting.method->name();
  said.promise = setting.method->promise();
  said.tolerance = setting.options.tolerance;
  said.max_checks = setting.options.max_checks;
  said.separation = setting.options.separation;
  said.group_queries = group.queries().size();
  return said;
}

bool is_at_limit(const fast::Answer& answer, std::int64_t max_checks) {
  if (answer.verdict == fast::Verdict::undecided) return true;
  return max_checks > 0 && std::int64_t{answer.checks} >= max_checks;
}

void set_counts(const judge::Judgement& judgement, Measurement& said) {
  static_cast<JudgedAnswers&>(said) = counts_of(judgement);
  said.asked = judgement.queries;
  said.late = judgement.late;
  said.keeps_promise = said.promise == fast::Promise::none || judge::keeps(judgement, said.promise);
}

/// Passes on the wrong answers.
void tell_wrong(const data::QueryGroup& group, const Measurement& said,
                const judge::Standard& standard, const judge::Judgement& judgement,
                const OnWrong& on_wrong) {
  if (!on_wrong) return;
  for (const judge::WrongAnswer& wrong : judgement.wrong_answers) {
    if (!judge::breaks(wrong.fault, said.promise)) continue;
    data::QueryPlace place = group.place_of(wrong.index);
    on_wrong({.source = std::move(place.source),
              .index = place.index,
              .query = base::AnyQuery(group.queries(), wrong.index),
              .separation = said.separation,
              .faults = {judge::to_text(said.method, wrong)},
              .answers = {{.solver = said.method,
                           .answer = wrong.given,
                           .failure = wrong.failure,
                           .standard = standard}}});
  }
}

class MeasureRun {
 public:
  MeasureRun(const data::QueryGroup& group, judge::GroundTruthCache& truths,
             std::span<const Setting> settings, const fast::Method& reference,
             const MeasureOptions& options)
      : group_(group),
        samples_(group),
        truths_(truths),
        settings_(settings),
        reference_(solvers::solver_in_process(reference, {})),
        options_(options) {
    for (const Setting& setting : settings) {
      solvers_.push_back(
          setting.in_children
              ? solvers::solver_in_children(*setting.method, setting.options, options.process)
              : solvers::solver_in_process(*setting.method, setting.options));
      solvers_.back()->allow(setting.allowance);
      timed_.emplace_back(*solvers_.back(), samples_, setting.options.separation);
    }
  }

  [[nodiscard]] std::vector<Measurement> measurements() {
    const std::size_t asked = timed_.size();
    for (std::size_t i = 0; i < asked && !stopped(); ++i) {
      timed_[i].choose_sample({.most = options_.count,
                               .seconds = options_.seconds,
                               .companion = reference_.get(),
                               .stop = options_.stop});
      tell(0.3 * static_cast<double>(i + 1) / static_cast<double>(asked));
    }
    if (stopped()) return {};
    if (options_.same_sample) share_samples();
    for (std::size_t i = 0; i < asked; ++i) {
      ask_singly(timed_[i]);
      tell(0.3 + 0.2 * static_cast<double>(i + 1) / static_cast<double>(asked));
    }
    add_references();
    for (std::size_t i = 0; i < options_.repetitions && !stopped(); ++i) {
      repeat(i);
      tell(0.5 + 0.4 * static_cast<double>(i + 1) / static_cast<double>(options_.repetitions));
    }
    std::vector<Measurement> result;
    for (std::size_t i = 0; i < asked; ++i) {
      if (is_complete(i)) result.push_back(report(i));
    }
    tell(1.0);
    return result;
  }

 private:
  [[nodiscard]] bool stopped() const { return base::is_stopped(options_.stop); }

  void tell(double fraction) const {
    if (options_.on_progress) options_.on_progress(fraction);
  }

  /// Gives all settings of one method the smallest of their samples.
  void share_samples() {
    std::map<std::string, std::size_t> smallest;
    for (const jobs::TimedSolver& timed : timed_) {
      const auto [size, is_new] =
          smallest.try_emplace(timed.solver().name(), timed.queries().size());
      size->second = std::min(size->second, timed.queries().size());
    }
    for (jobs::TimedSolver& timed : timed_) timed.take(smallest.at(timed.solver().name()));
  }

  /// A sample at a separation: the key to the truths and the reference that a solver is compared
  /// with.
  using Key = std::tuple<std::size_t, double, Norm>;

  static Key key_of(const jobs::TimedSolver& timed) {
    return {timed.queries().size(), timed.separation().distance, timed.separation().norm};
  }

  /// The times of single queries, and the truth.
  void ask_singly(const jobs::TimedSolver& timed) {
    single_times_.push_back(
        timed.time_singles(timed.queries().size(), options_.seconds, options_.stop)
            .value_or(std::vector<double>()));
    const auto [known, is_new] = known_.try_emplace(key_of(timed));
    if (is_new) known->second = truths_.of(timed.separation(), timed.positions(), options_.stop);
  }

  // ---- Timing -----------------------------------------------------------------------------------

  /// The reference on each of the samples, at each of the separations.
  void add_references() {
    for (std::size_t i = 0; i < settings_.size(); ++i) {
      const auto [place, is_new] = reference_of_.try_emplace(key_of(timed_[i]), timed_.size());
      if (!is_new) continue;
      jobs::TimedSolver reference(*reference_, samples_, timed_[i].separation());
      reference.take(timed_[i].queries().size());
      timed_.push_back(std::move(reference));
    }
  }

  void repeat(std::size_t repetition) {
    for (const std::size_t i : jobs::order_of_repetition(timed_.size(), repetition)) {
      if (stopped()) return;
      const bool is_first = timed_[i].times().repetitions.empty();
      if (is_first || timed_[i].seconds_spent() < options_.seconds) timed_[i].repeat();
    }
  }

  // ---- Reporting --------------------------------------------------------------------------------

  [[nodiscard]] const jobs::TimedSolver& reference_for(const jobs::TimedSolver& timed) const {
    return timed_[reference_of_.at(key_of(timed))];
  }

  [[nodiscard]] const std::vector<judge::GroundTruth>& known_of(
      const jobs::TimedSolver& timed) const {
    return known_.at(key_of(timed));
  }

  [[nodiscard]] bool is_complete(std::size_t index) const {
    const jobs::TimedSolver& timed = timed_[index];
    return !timed.times().repetitions.empty() &&
           !reference_for(timed).times().repetitions.empty() &&
           known_of(timed).size() == timed.queries().size();
  }

  [[nodiscard]] Measurement report(std::size_t index) const {
    const jobs::TimedSolver& timed = timed_[index];
    Measurement said = of_separation(group_, options_.experiment, settings_[index]);
    const judge::Judgement judgement = timed.judge(known_of(timed));
    set_counts(judgement, said);
    said.outside = judgement.outside;
    said.left_out = judgement.left_out;
    said.nanoseconds = timed.times().median();
    said.repetitions = timed.times().repetitions.size();
    said.certified_nanoseconds = reference_for(timed).times().median();
    for (const solvers::StageCount& stage :
         solvers::count_stages(timed.solver().info(), timed.answers())) {
      said.stages.push_back({std::string(stage.stage), stage.queries});
    }
    tell_wrong(group_, said, timed.solver().standard(), judgement, options_.on_wrong);
    describe_queries(index, said);
    return said;
  }

  /// Counts and times that are about each query.
  void describe_queries(std::size_t index, Measurement& said) const {
    judge::ToiErrors achieved_tolerances;
    const std::vector<judge::GroundTruth>& known = known_of(timed_[index]);
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (timed_[index].why_unasked(i)) continue;
      const bool collides = known[i].collides;
      const fast::Answer& answer = timed_[index].answers()[i];
      said.at_limit += is_at_limit(answer, said.max_checks) ? 1U : 0U;
      if (std::isinf(single_times_[index][i])) continue;
      (collides ? said.collision_times : said.no_collision_times).add(single_times_[index][i]);
      const bool is_yes = answer.verdict == fast::Verdict::yes;
      if (is_yes && answer.tolerance >= 0.0) achieved_tolerances.add(answer.tolerance);
    }
    said.achieved_tolerance = spread_of(achieved_tolerances);
  }

  const data::QueryGroup& group_;
  jobs::Samples samples_;
  judge::GroundTruthCache& truths_;
  std::span<const Setting> settings_;
  std::unique_ptr<solvers::Solver> reference_;
  const MeasureOptions& options_;
  std::vector<std::unique_ptr<solvers::Solver>> solvers_;
  /// The settings in their order, then the reference on each of their samples.
  std::vector<jobs::TimedSolver> timed_;
  /// The times of single queries by setting, in the order of their samples; none if stopped.
  std::vector<std::vector<double>> single_times_;
  /// The truths of each sample at each separation; fewer than were asked if stopped.
  std::map<Key, std::vector<judge::GroundTruth>> known_;
  /// The position of the reference in timed_.
  std::map<Key, std::size_t> reference_of_;
};

}  // namespace

std::vector<Measurement> measure(const data::QueryGroup& group, judge::GroundTruthCache& truths,
                                 std::span<const Setting> settings, const fast::Method& reference,
                                 const MeasureOptions& options) {
  if (group.queries().empty()) throw std::invalid_argument(group.name() + ": no queries");
  if (options.count == 0) throw std::invalid_argument("count must be at least 1");
  if (options.repetitions == 0) throw std::invalid_argument("repetitions must be at least 1");
  if (!(options.seconds > 0.0)) throw std::invalid_argument("seconds must be positive");
  return MeasureRun(group, truths, settings, reference, options).measurements();
}

std::optional<Measurement> judge_all(const data::QueryGroup& group, judge::GroundTruthCache& truths,
                                     const fast::Method& method, const fast::MethodOptions& options,
                                     Experiment experiment, const std::atomic<bool>* stop,
                                     const OnWrong& on_wrong) {
  const Queries queries = group.queries();
  std::vector<std::size_t> positions(queries.size());
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  const std::vector<judge::GroundTruth> known = truths.of(options.separation, positions, stop);
  if (known.size() < queries.size()) return std::nullopt;
  std::vector<fast::Answer> answers(queries.size());
  const auto solver = solvers::solver_in_process(method, options);
  const solvers::SolveReply reply =
      solver->solve({.queries = queries, .separation = options.separation}, answers);
  Measurement said = of_separation(group, experiment, {.method = &method, .options = options});
  const judge::Standard standard = solver->standard();
  judge::Judgement judgement;
  for (const judge::GroundTruth& truth : known) {
    if (reply.why_unasked(truth.index)) {
      ++said.outside;
      continue;
    }
    judgement.add({queries.part(truth.index, 1), options.separation}, truth, answers[truth.index],
                  standard, judge::failure_at(reply.failures, truth.index));
    said.at_limit += is_at_limit(answers[truth.index], said.max_checks) ? 1U : 0U;
  }
  set_counts(judgement, said);
  tell_wrong(group, said, standard, judgement, on_wrong);
  return said;
}

}  // namespace touchstone::verify::report

#include "verify/report/experiments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "touchstone/certified.hpp"
#include "verify/base/deadline.hpp"
#include "verify/generate/families.hpp"
#include "verify/generate/workload.hpp"
#include "verify/jobs/timing.hpp"
#include "verify/judge/ground_truth_cache.hpp"
#include "verify/report/stability.hpp"
#include "verify/solvers/published.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::report {
namespace {

using Methods = std::span<const fast::Method* const>;

constexpr std::array<double, 7> distances{1e-100, 1e-30, 1e-16, 1e-8, 1e-4, 1e-2, 1.0};
constexpr std::array<double, 9> tolerances{1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0};
constexpr std::array<double, 7> scales{1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0, 1000.0};
constexpr std::array<std::int64_t, 6> limits{10, 100, 1'000, 10'000, 100'000, 1'000'000};

/// The limit of checks on the map of stability, whose queries are the hardest.
constexpr std::int64_t stability_limit = 10'000;

/// The experiment on filters: checks a query, and queries of a family and of a scale.
constexpr std::int64_t filter_limit = 100'000;
constexpr std::size_t most_of_family = 500, most_of_scale = 10'000;

/// Shares of a budget: that of the trials on groups, and within it that of the plugins; and the
/// time of a setting as a multiple of MeasureOptions::seconds.
constexpr double trials_budget = 0.65, plugins_budget = 0.6, cost_of_setting = 8.0;

/// The shares of the experiments on groups and on filters in the whole run; the rest is the map of
/// stability's.
constexpr double part_of_trials = 0.8, part_of_filters = 0.05;

template <class Thing, class Range>
bool is_one_of(const Thing& thing, const Range& things) {
  return std::ranges::find(things, thing) != things.end();
}

fast::MethodOptions options_of(const fast::MethodInfo& method) {
  fast::MethodOptions options;
  options.max_checks = method.usual_max_checks;
  return options;
}

/// Settings that are measured side by side.
struct Trial {
  Experiment experiment = Experiment::field;
  std::vector<Setting> settings = {};
};

Trial field_trial(Methods methods) {
  Trial trial{.experiment = Experiment::field};
  for (const auto* method : methods) trial.settings.push_back({method, options_of(method->info())});
  return trial;
}

Trial separation_trial(Methods methods) {
  Trial trial{.experiment = Experiment::separation};
  for (const double distance : distances) {
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      for (const auto* method : methods) {
        const fast::MethodInfo& info = method->info();
        if (!info.variant_of.empty() || !info.measures_in(norm)) continue;
        fast::MethodOptions options = options_of(info);
        options.separation = {.distance = distance, .norm = norm};
        trial.settings.push_back({method, options});
      }
    }
  }
  return trial;
}

Trial tolerance_trial(Methods methods) {
  Trial trial{.experiment = Experiment::tolerance};
  for (const auto* method : methods) {
    const fast::MethodInfo& info = method->info();
    if (!info.variant_of.empty() || !info.is_tolerance_driven) continue;
    for (const double tolerance : tolerances) {
      fast::MethodOptions options = options_of(info);
      options.tolerance = tolerance;
      trial.settings.push_back({method, options});
    }
  }
  return trial;
}

/// The trial of Tight-Inclusion, the only method with a filter.
Trial checks_trial(Methods methods) {
  Trial trial{.experiment = Experiment::checks};
  for (const auto* method : methods) {
    const fast::MethodInfo& info = method->info();
    if (!info.variant_of.empty() || !info.filter) continue;
    for (const std::int64_t limit : limits) {
      fast::MethodOptions options = options_of(info);
      options.max_checks = limit;
      trial.settings.push_back({method, options});
    }
  }
  return trial;
}

std::vector<const fast::Method*> find_methods(std::span<const std::string> names) {
  std::vector<const fast::Method*> found;
  for (const std::string& name : names) found.push_back(&solvers::find_any(name));
  return found;
}

std::vector<Trial> trials_of(Methods methods) {
  std::vector<Trial> trials{field_trial(methods), tolerance_trial(methods), checks_trial(methods),
                            separation_trial(methods)};
  std::erase_if(trials, [](const Trial& trial) { return trial.settings.empty(); });
  return trials;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string today() {
  const auto now = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const std::chrono::year_month_day day(now);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
}

class ExperimentRun {
 public:
  ExperimentRun(std::span<const data::QueryGroup> groups, const ExperimentOptions& options)
      : groups_(groups), options_(options), methods_(find_methods(options.methods)) {
    if (options.budget > 0.0) deadline_ = base::Deadline(options.budget);
    if (!methods_.empty()) return;
    for (const std::string& name : solvers::all_names()) {
      const fast::Method& method = solvers::find_any(name);
      if (is_asked(method.info().terms)) methods_.push_back(&method);
    }
  }

  [[nodiscard]] Measurements result() {
    result_.machine = processor();
    result_.date = today();
    for (const data::QueryGroup& group : groups_) {
      result_.groups.push_back({.name = group.name(),
                                .kind = group.kind(),
                                .queries = group.queries().size(),
                                .digest = group.digest()});
    }
    const std::vector<Trial> trials = chosen_trials();
    const double seconds = seconds_of_setting(trials);
    for (std::size_t group = 0; group < groups_.size(); ++group) {
      judge::GroundTruthCache truths(groups_[group], options_.threads);
      for (std::size_t trial = 0; trial < trials.size() && !stopped(); ++trial) {
        const auto place = static_cast<double>(group * trials.size() + trial);
        const auto all = static_cast<double>(groups_.size() * trials.size());
        measure_trial(groups_[group], truths, trials[trial], seconds,
                      [&](double fraction) { tell(part_of_trials * (place + fraction) / all); });
      }
    }
    judge_filters();
    if (options_.stability_count > 0 && !stopped()) map_stability();
    result_.interrupted = result_.interrupted || stopped();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool stopped() const {
    return base::is_stopped(options_.stop) || deadline_.is_over();
  }

  void tell(double fraction) const {
    if (options_.on_progress) options_.on_progress(fraction);
  }

  /// The map of stability is of straight lines.
  [[nodiscard]] bool is_asked(const fast::Terms& terms) const {
    const bool takes_lines = jobs::takes_curves(terms, QueryShape{});
    return takes_lines || std::ranges::any_of(groups_, [&](const data::QueryGroup& group) {
             return jobs::takes_curves(terms, group.shape());
           });
  }

  /// The seconds of a setting of our own methods: with a budget, those that fit into it.
  [[nodiscard]] double seconds_of_setting(const std::vector<Trial>& trials) const {
    if (options_.budget == 0.0) return options_.seconds;
    std::size_t settings = 0;
    for (const Trial& trial : trials) settings += trial.settings.size() + 1;
    const auto all = static_cast<double>(settings * std::max<std::size_t>(1, groups_.size()));
    const double ours = options_.plugins.empty() ? 1.0 : 1.0 - plugins_budget;
    return std::min(options_.seconds,
                    trials_budget * ours * options_.budget / cost_of_setting / all);
  }

  /// The wall-clock seconds that a plugin may take on a group.
  [[nodiscard]] double allowance_of_plugin() const {
    if (options_.budget == 0.0) return std::numeric_limits<double>::infinity();
    return trials_budget * plugins_budget * options_.budget /
           static_cast<double>(options_.plugins.size() * std::max<std::size_t>(1, groups_.size()));
  }

  [[nodiscard]] std::vector<Trial> chosen_trials() const {
    std::vector<Trial> trials = trials_of(methods_);
    for (Trial& trial : trials) {
      if (trial.experiment != Experiment::field) continue;
      for (const fast::Method* const plugin : options_.plugins) {
        trial.settings.push_back({plugin, {}, true, allowance_of_plugin()});
      }
    }
    std::erase_if(trials, [this](const Trial& trial) { return !is_chosen(trial.experiment); });
    return trials;
  }

  [[nodiscard]] bool is_chosen(Experiment experiment) const {
    return options_.experiments.empty() || is_one_of(experiment, options_.experiments);
  }

  /// At least 1.
  [[nodiscard]] std::size_t count_of(const Trial& trial) const {
    return trial.experiment == Experiment::separation ? (options_.count + 3) / 4 : options_.count;
  }

  void measure_trial(const data::QueryGroup& group, judge::GroundTruthCache& truths,
                     const Trial& trial, double seconds,
                     const std::function<void(double)>& on_progress) {
    std::vector<Setting> settings = trial.settings;
    std::erase_if(settings, [&](const Setting& setting) {
      return !jobs::takes_curves(setting.method->info().terms, group.shape());
    });
    std::vector<Measurement> measured =
        measure(group, truths, settings, solvers::find_method(fast::certified_info().name),
                {.experiment = trial.experiment,
                 .count = count_of(trial),
                 .seconds = seconds,
                 .repetitions = options_.repetitions,
                 .process = options_.process,
                 .same_sample = trial.experiment != Experiment::field,
                 .on_progress = on_progress,
                 .on_wrong = options_.on_wrong,
                 .stop = options_.stop});
    std::ranges::move(measured, std::back_inserter(result_.all));
  }

  // ---- Filters ----------------------------------------------------------------------------------

  [[nodiscard]] std::vector<data::QueryGroup> groups_for_filters(Kind kind) const {
    std::vector<data::QueryGroup> groups;
    for (const generate::Family& family : generate::families()) {
      if (!generate::supports(family, kind)) continue;
      data::QueryGroup& group = groups.emplace_back(std::string(family.name), kind);
      group.read(
          *generate::open_family(family, kind, options_.seed,
                                 std::min(options_.count, most_of_family)),
          [](double) {}, [] { return false; });
    }
    return groups;
  }

  void judge_filters() {
    std::vector<const fast::Method*> chosen;
    const auto has_filter = [](const auto* method) { return method->info().filter.has_value(); };
    std::ranges::copy_if(methods_, std::back_inserter(chosen), has_filter);
    if (chosen.size() < 2 || !is_chosen(Experiment::filter)) return;
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      if (std::ranges::find(groups_, kind, &data::QueryGroup::kind) == groups_.end()) continue;
      for (const data::QueryGroup& group : groups_for_filters(kind))
        judge(chosen, group, std::nullopt);
      for (const bool two_decimals : {false, true}) {
        for (const double scale : scales) {
          judge(chosen,
                generate::end_contacts(kind, {.scale = scale,
                                              .two_decimals = two_decimals,
                                              .seed = options_.seed,
                                              .count = std::min(options_.count, most_of_scale)}),
                scale);
        }
      }
    }
  }

  void judge(const std::vector<const fast::Method*>& chosen, const data::QueryGroup& group,
             std::optional<double> scale) {
    fast::MethodOptions asked;
    asked.max_checks = filter_limit;
    judge::GroundTruthCache truths(group, options_.threads);
    std::vector<Measurement> side_by_side;
    for (const fast::Method* const method : chosen) {
      if (stopped()) return;
      auto judged = judge_all(group, truths, *method, asked, Experiment::filter, options_.stop,
                              options_.on_wrong);
      if (!judged) return;
      judged->scale = scale;
      side_by_side.push_back(std::move(*judged));
    }
    std::ranges::move(side_by_side, std::back_inserter(result_.all));
  }

  void map_stability() {
    std::vector<std::unique_ptr<solvers::Solver>> solvers;
    std::vector<const solvers::Solver*> asked;
    for (const auto* method : methods_) {
      if (!method->info().terms.straight) continue;
      fast::MethodOptions method_options;
      method_options.max_checks = stability_limit;
      solvers.push_back(solvers::solver_in_process(*method, method_options));
      asked.push_back(solvers.back().get());
    }
    for (const fast::Method* const plugin : options_.plugins) {
      fast::MethodOptions method_options;
      method_options.max_checks = stability_limit;
      solvers.push_back(solvers::solver_in_children(*plugin, method_options, options_.process));
      asked.push_back(solvers.back().get());
    }
    if (asked.empty()) return;
    // The rest is for the page.
    const double left = 0.85 * deadline_.seconds_left();
    StabilityOptions map_options{.seed = options_.seed,
                                 .count = options_.stability_count,
                                 .seconds = std::isinf(left) ? 0.0 : left};
    for (const auto& hardness : generate::hardnesses()) map_options.hardnesses.push_back(&hardness);
    map_options.certify.threads = options_.threads;
    map_options.certify.solvers = asked;
    map_options.certify.stop = options_.stop;
    map_options.certify.on_progress = [&](double fraction) {
      constexpr double before = part_of_trials + part_of_filters;
      tell(before + (1.0 - before) * fraction);
    };
    const StabilityResult map = measure_stability(map_options);
    result_.stability = marks_of(map);
    result_.interrupted = result_.interrupted || map.unjudged_cells != 0;
  }

  std::span<const data::QueryGroup> groups_;
  const ExperimentOptions& options_;
  std::vector<const fast::Method*> methods_;
  base::Deadline deadline_;
  Measurements result_;
};

}  // namespace

Measurements run_experiments(std::span<const data::QueryGroup> groups,
                             const ExperimentOptions& options) {
  return ExperimentRun(groups, options).result();
}

}  // namespace touchstone::verify::report

#include "verify/stability/stability.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "verify/base/deadline.hpp"
#include "verify/jobs/budget.hpp"

namespace touchstone::verify::stability {
namespace {

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};

std::vector<StabilityCell> cells_of(const std::vector<const Hardness*>& sorts) {
  std::vector<StabilityCell> cells;
  for (const Hardness* hardness : sorts) {
    for (const Kind kind : kinds) {
      for (const int level : hardness->levels) {
        cells.push_back({.hardness = hardness, .level = level, .kind = kind, .judged = {}});
      }
    }
  }
  return cells;
}

jobs::CertifyResult judge(const StabilityCell& cell, const StabilityOptions& options,
                          const base::Deadline& deadline, bool is_short_of_time,
                          const std::function<void(double)>& on_progress) {
  const std::unique_ptr<data::QuerySource> source =
      open_hard_queries({.hardness = cell.hardness,
                         .level = cell.level,
                         .kind = cell.kind,
                         .separation = options.separation},
                        options.seed, options.count);
  jobs::CertifyOptions certify_options;
  certify_options.separation = source->recorded_separation();
  certify_options.threads = options.threads;
  certify_options.solvers = options.solvers;
  certify_options.on_progress = on_progress;
  certify_options.stop = options.stop;
  certify_options.deadline = deadline;
  certify_options.is_short_of_time = is_short_of_time;
  jobs::CertifyResult judged = jobs::certify(*source, certify_options);
  if (judged.error) throw std::runtime_error(source->name() + ": " + *judged.error);
  return judged;
}

}  // namespace

StabilityResult measure_stability(const std::vector<const Hardness*>& sorts,
                                  const StabilityOptions& options) {
  StabilityResult result{.separation = options.separation,
                         .seed = options.seed,
                         .count = options.count,
                         .total = {},
                         .cells = cells_of(sorts)};
  result.total.name = "total";
  jobs::Budget budget;
  if (options.seconds > 0.0) {
    budget = jobs::Budget(options.seconds, options.solvers, options.threads);
  }
  const auto stopped = [&] { return base::is_stopped(options.stop) || budget.is_over(); };
  std::size_t done = 0;
  for (; done < result.cells.size() && !stopped(); ++done) {
    const auto on_progress = [&](double fraction) {
      if (!options.on_progress) return;
      options.on_progress((static_cast<double>(done) + fraction) /
                          static_cast<double>(result.cells.size()));
    };
    const base::Deadline deadline = budget.begin_source(result.cells.size() - done);
    result.cells[done].judged =
        judge(result.cells[done], options, deadline, budget.is_limited(), on_progress);
    result.total += result.cells[done].judged;
    on_progress(1.0);
  }
  result.total.interrupted = result.total.interrupted || done < result.cells.size();
  result.unjudged_cells = result.cells.size() - done;
  result.cells.resize(done);
  return result;
}

double rate_of(judge::Fault fault, const jobs::CertifyResult& judged, std::size_t method) {
  const judge::Judgement& judgement = judged.methods.at(method).judgement;
  const std::uint64_t misses = judgement.queries - judgement.collisions;
  const bool about_misses =
      fault == judge::Fault::false_positive || fault == judge::Fault::beyond_tolerance;
  const std::uint64_t among = judge::is_error(fault) ? judgement.queries
                              : about_misses         ? misses
                                                     : judgement.collisions;
  const std::uint64_t count = judgement.total(fault);
  return among == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(among);
}

Outcome outcome_of(const jobs::CertifyResult& judged, std::size_t method) {
  const jobs::MethodResult& of_method = judged.methods.at(method);
  const auto worst = judge::worst_of(of_method.judgement, of_method.promise);
  if (!worst) return {};
  return {.worst = worst->fault,
          .is_slight = worst->is_slight,
          .rate = rate_of(worst->fault, judged, method)};
}

std::optional<double> checks_per_query(const jobs::MethodResult& method) {
  const judge::Judgement& judged = method.judgement;
  if (judged.queries == 0 || judged.checks == 0) return std::nullopt;
  return static_cast<double>(judged.checks) / static_cast<double>(judged.queries);
}

std::optional<double> nanoseconds_per_query(const jobs::MethodResult& method) {
  if (!method.timed || method.judgement.queries == 0) return std::nullopt;
  return method.judgement.nanoseconds_per_query();
}

bool has_wrong_answers(const StabilityResult& result) {
  const auto is_wrong = [](const jobs::MethodResult& method) {
    return !judge::keeps(method.judgement, method.promise);
  };
  return result.total.label_mismatches != 0 || std::ranges::any_of(result.total.methods, is_wrong);
}

}  // namespace touchstone::verify::stability

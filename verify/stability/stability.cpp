#include "verify/stability/stability.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "verify/base/deadline.hpp"

namespace touchstone::verify::stability {
namespace {

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};

/// Worst first; the crash stands for all errors.
constexpr std::array by_weight{judge::Fault::false_negative,   judge::Fault::late_toi,
                               judge::Fault::early_toi_upper,  judge::Fault::crash,
                               judge::Fault::beyond_tolerance, judge::Fault::false_positive};

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
  const auto stopped = [&] { return base::is_stopped(options.stop); };
  std::size_t done = 0;
  for (; done < result.cells.size() && !stopped(); ++done) {
    const auto on_progress = [&](double fraction) {
      if (!options.on_progress) return;
      options.on_progress((static_cast<double>(done) + fraction) /
                          static_cast<double>(result.cells.size()));
    };
    result.cells[done].judged = judge(result.cells[done], options, on_progress);
    result.total += result.cells[done].judged;
    on_progress(1.0);
  }
  result.total.interrupted = result.total.interrupted || done < result.cells.size();
  result.cells.resize(done);
  return result;
}

double rate_of(judge::Fault fault, const jobs::CertifyResult& judged, std::size_t method) {
  const std::uint64_t misses = judged.queries - judged.collisions;
  const bool about_misses =
      fault == judge::Fault::false_positive || fault == judge::Fault::beyond_tolerance;
  const std::uint64_t among = judge::is_error(fault) ? judged.queries
                              : about_misses         ? misses
                                                     : judged.collisions;
  const std::uint64_t count = judged.methods.at(method).judgement.total(fault);
  return among == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(among);
}

Outcome outcome_of(const jobs::CertifyResult& judged, std::size_t method) {
  const judge::Judgement& judgement = judged.methods.at(method).judgement;
  const auto* const worst = std::ranges::find_if(
      by_weight, [&](judge::Fault fault) { return judgement.total(fault) != 0; });
  if (worst == by_weight.end()) return {};
  return {.worst = *worst, .rate = rate_of(*worst, judged, method)};
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

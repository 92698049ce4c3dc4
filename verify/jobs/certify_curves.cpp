#include "verify/jobs/certify_curves.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <span>

#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/curved.hpp"
#include "touchstone/number.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/deadline.hpp"
#include "verify/base/thread_clock.hpp"
#include "verify/baselines/curved_methods.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judge.hpp"

namespace touchstone::verify::jobs {
namespace {

/// So many queries at a time: progress and stops are felt.
constexpr std::size_t block_size = 4096;

/// Bits of a time of impact before it is rounded.
constexpr unsigned long precision = 64;

/// What is found of one query.
struct Finding {
  exact::Decision truth;
  bool is_wrong = false;
  double toi = fast::no_number;
  std::string certificate;
  bool is_beyond_limits = false;
  double seconds = 0.0;
};

bool is_right(const fast::CertifiedResult& found, const exact::Decision& truth) {
  if ((found.verdict == fast::Verdict::yes) != truth.collides() ||
      (found.verdict == fast::Verdict::no) == truth.collides()) {
    return false;
  }
  if (!truth.collides()) return true;
  if (*truth.toi == exact::Rational(0)) return found.toi_lower == 0.0;
  return exact::Rational(found.toi_lower) < *truth.toi &&
         exact::Rational(found.toi_upper) >= *truth.toi;
}

Finding finding_of(Kind kind, const CurvedQueries& queries, std::size_t i,
                   const fast::CertifiedResult& found, const CurvedOptions& options) {
  Finding result;
  const CurvedQuery query = queries.query(i);
  const double begin = base::thread_nanoseconds();
  result.truth = exact::decide(kind, query, options.separation);
  const exact::Decision& truth = result.truth;
  result.seconds = (base::thread_nanoseconds() - begin) * 1e-9;
  result.is_wrong = !is_right(found, truth);
  if (truth.collides()) {
    exact::AlgebraicNumber toi = *truth.toi;
    toi.refine_to_level(precision);
    result.toi = exact::round_to_nearest(toi.interval().upper);
  }
  if (!options.prove) return result;
  try {
    exact::write(result.certificate, exact::prove(kind, query, truth),
                 options.label + std::to_string(i));
  } catch (const exact::CertificateLimitError&) {
    result.is_beyond_limits = true;
  }
  return result;
}

/// The verdict and time of Tight-Inclusion.
std::optional<double> include_tightly(Kind kind, const CurvedQueries& queries, std::size_t i) {
  const auto found = fast::tight_inclusion(kind, queries, i);
  if (found.verdict == fast::Verdict::no) return std::nullopt;
  return found.toi;
}

/// Judges a method by the times of impact, NaN for no contact.
/// Nothing if it is stopped.
std::optional<CurvedJudgement> judge(const baselines::CurvedMethod& method, Kind kind,
                                     const CurvedQueries& queries, std::span<const double> toi,
                                     const std::atomic<bool>* stop) {
  constexpr double late = 1e-9;
  CurvedJudgement result{.name = method.name};
  for (std::size_t i = 0; i < toi.size(); ++i) {
    if (base::is_stopped(stop)) return std::nullopt;
    const double begin = base::thread_nanoseconds();
    const std::optional<double> found = method.solve(kind, queries, i);
    result.seconds += (base::thread_nanoseconds() - begin) * 1e-9;
    const bool collides = !std::isnan(toi[i]);
    if (collides && !found) ++result.false_negatives;
    if (!collides && found) ++result.false_positives;
    if (collides && found && *found > toi[i] + late) ++result.late;
  }
  return result;
}

std::vector<CurvedJudgement> judge_others(Kind kind, const CurvedQueries& queries,
                                          std::span<const double> toi,
                                          const std::atomic<bool>* stop) {
  std::vector<CurvedJudgement> result;
  const auto add = [&](const baselines::CurvedMethod& method) {
    if (auto judged = judge(method, kind, queries, toi, stop)) result.push_back(*judged);
  };
  if (queries.degree == 2 || queries.degree == 3) add({"tight_inclusion", include_tightly});
  for (const baselines::CurvedMethod& method : baselines::curved_methods()) add(method);
  return result;
}

/// Asks a plugin about the queries of one call.
class PluginRun {
 public:
  PluginRun(JudgedPlugin& judged, Kind kind, const CurvedQueries& queries, Separation separation)
      : judged_(judged),
        kind_(kind),
        queries_(queries),
        separation_(separation),
        method_(solvers::curved_method(judged.plugin, queries)) {
    solvers::SolverProcessOptions process = judged.process;
    process.query_limit_seconds = judged.limits.seconds();
    solver_ = solvers::solver_in_children(*method_, judged.options, process);
    result_.name = judged.plugin.name;
    result_.promise = judged.plugin.promise;
  }

  /// Judges the answers to the queries from number `first` on. They are left out if it is stopped.
  void judge_block(std::size_t first, std::span<const Finding> findings) {
    std::vector<Query> asked;
    for (std::size_t i = 0; i < findings.size(); ++i) {
      asked.push_back(solvers::stand_in(queries_, first + i));
    }
    std::vector<fast::Answer> answers(asked.size());
    const solvers::SolveReply reply =
        solver_->solve_timed({.kind = kind_, .queries = asked, .separation = separation_}, answers);
    if (reply.stopped) return;
    judge::Judgement block;
    for (std::size_t i = 0; i < findings.size(); ++i) {
      if (const auto why = reply.why_unasked(i)) {
        block.add_unasked(*why, first + i);
      } else {
        block.add({kind_, asked[i], separation_}, judge::truth_of(first + i, findings[i].truth),
                  answers[i], solver_->standard(), judge::failure_at(reply.failures, i));
      }
    }
    block.unplaced_crashes = reply.unplaced_crashes;
    block.nanoseconds = reply.time.value().processor_nanoseconds;
    result_.judgement += block;
  }

  [[nodiscard]] CurvedPluginResult finish() {
    for (std::uint64_t i = 0; i < result_.judgement.count(judge::Fault::hang); ++i) {
      judged_.limits.add({});
    }
    result_.output = solver_->take_output();
    return std::move(result_);
  }

 private:
  JudgedPlugin& judged_;
  Kind kind_;
  const CurvedQueries& queries_;
  Separation separation_;
  std::unique_ptr<fast::Method> method_;
  std::unique_ptr<solvers::Solver> solver_;
  CurvedPluginResult result_;
};

/// True if the oracle's answer is not the known one. \param toi of the oracle, NaN for no contact
bool contradicts(const std::optional<double>& known, double toi) {
  return known ? toi != *known : !std::isnan(toi);
}

}  // namespace

CurvedResult certify_curves(Kind kind, const CurvedQueries& queries, const CurvedOptions& options) {
  CurvedResult sum;
  const int threads = base::cores_for(options.threads);
  tbb::task_arena arena(threads);
  std::vector<fast::CertifiedResult> found;
  std::vector<Finding> findings;
  std::deque<PluginRun> plugins;
  for (JudgedPlugin& judged : options.plugins) {
    plugins.emplace_back(judged, kind, queries, options.separation);
  }
  for (std::size_t first = 0; first < queries.size(); first += block_size) {
    const std::size_t count = std::min(block_size, queries.size() - first);
    found.assign(count, {});
    findings.assign(count, {});
    CurvedQueries block = queries;
    block.numbers = queries.numbers.subspan(first * queries.numbers_of_query(),
                                            count * queries.numbers_of_query());
    const double begin = base::thread_nanoseconds();
    fast::solve(kind, block, found, {.separation = options.separation, .max_threads = 1});
    sum.certified_seconds += (base::thread_nanoseconds() - begin) * 1e-9;
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        if (base::is_stopped(options.stop)) return;
        findings[i] = finding_of(kind, queries, first + i, found[i], options);
      });
    });
    if (base::is_stopped(options.stop)) break;
    for (PluginRun& plugin : plugins) plugin.judge_block(first, findings);
    std::string certificates;
    for (std::size_t i = 0; i < count; ++i) {
      const Finding& one = findings[i];
      ++sum.queries;
      if (one.truth.collides()) ++sum.collide;
      if (one.is_wrong) sum.wrong.push_back(first + i);
      ++sum.decided_by.at(static_cast<std::size_t>(found[i].stage));
      if (!one.certificate.empty()) ++sum.certificates;
      if (one.is_beyond_limits) ++sum.beyond_limits;
      sum.oracle_seconds += one.seconds;
      sum.toi.push_back(one.toi);
      certificates += one.certificate;
      if (options.on_truth) options.on_truth(first + i, one.truth);
      if (!options.truth.empty() && contradicts(options.truth[first + i], one.toi)) {
        sum.against_truth.push_back(first + i);
      }
    }
    if (options.on_certificates && !certificates.empty()) options.on_certificates(certificates);
    if (options.on_progress) {
      options.on_progress(static_cast<double>(sum.queries) / static_cast<double>(queries.size()));
    }
  }
  if (options.judge_others && !queries.is_rational && is_zero(options.separation)) {
    sum.others = judge_others(kind, queries, sum.toi, options.stop);
  }
  for (PluginRun& plugin : plugins) sum.plugins.push_back(plugin.finish());
  return sum;
}

}  // namespace touchstone::verify::jobs

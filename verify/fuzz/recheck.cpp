#include "verify/fuzz/recheck.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/base/deadline.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/fuzz/shrink.hpp"
#include "verify/judge/terms.hpp"

namespace touchstone::verify::fuzz {
namespace {

using fast::Answer;
using fast::Verdict;

/// The number of queries after which the rest of a block is not asked: those that ended the
/// solver's process or took too long.
constexpr std::size_t most_failures = 4;

/// True if the query was asked alone, in a process of its own, before it was a finding.
bool is_confirmed_alone(judge::Fault what) {
  return what == judge::Fault::crash || what == judge::Fault::exit || what == judge::Fault::hang;
}

/// True if the same bounds are missing in both.
bool lacks_same_bounds(const Answer& a, const Answer& b) {
  return std::isnan(a.toi_lower) == std::isnan(b.toi_lower) &&
         std::isnan(a.toi_upper) == std::isnan(b.toi_upper);
}

/// Empty where it would exceed the format's limits, and for elements, which it has no form for.
std::string certificate(const AnyQuery& query, const exact::Decision& verdict,
                        std::string_view label) {
  if (is_element(query.kind())) return {};
  try {
    return exact::certificate_stream(exact::prove(query.queries(), 0, verdict, {}), label);
  } catch (const exact::CertificateLimitError&) {
    return {};
  }
}

}  // namespace

judge::Standard standard_of(const fast::Method& method, const FuzzOptions& options) {
  judge::Standard standard = judge::standard_of(method.info());
  standard.promise = options.promise.value_or(standard.promise);
  return standard;
}

solvers::SolverProcessOptions process_options(const FuzzOptions& options) {
  return {.query_limit_seconds = options.query_limit_seconds,
          .most_failures = most_failures,
          .stop = options.stop,
          .limits = options.limits};
}

base::Deadline solver_deadline(const base::Deadline& deadline) {
  constexpr double least_seconds = 1e-3;
  return base::Deadline(std::max(least_seconds, deadline.seconds_left()));
}

FailingCase failing_case(AnyQuery query, const Answer& answer, const exact::Decision& verdict,
                         std::string detail, std::string_view label) {
  std::optional<exact::DoubleInterval> toi;
  if (verdict.collides()) toi = verdict.toi->enclosure();
  std::string proof = certificate(query, verdict, label);
  return {.query = std::move(query),
          .answer = answer,
          .collides = verdict.collides(),
          .toi = toi,
          .truth = judge::to_text(judge::truth_of(0, verdict)),
          .detail = std::move(detail),
          .certificate = std::move(proof)};
}

Recheck::Recheck(const fast::Method& method, const Finding& finding, const FuzzOptions& options)
    : finding_(finding),
      standard_(standard_of(method, options)),
      separation_(options.separation),
      query_limit_seconds_(options.query_limit_seconds),
      of_judge_(finding.method == judge_name() && method.name() != judge_name()),
      solver_(method, process_options(options)),
      method_options_(method_options(options)) {
  if (of_judge_) standard_ = judge::standard_of(fast::certified_info());
}

std::optional<FailingCase> Recheck::ask(const AnyQuery& query, const base::Deadline& deadline) {
  if (!is_valid(query) || deadline.is_over()) return std::nullopt;
  if (!judge::admits(standard_.terms, query, separation_)) return std::nullopt;
  const std::optional<Reply> reply = reply_to(query, deadline);
  if (!reply) return std::nullopt;
  const exact::Decision verdict = exact::decide(query.queries(), 0, separation_);
  const auto diagnosis = diagnose_reply(query, judge::truth_of(0, verdict), *reply);
  if (!diagnosis || !is_same(*diagnosis)) return std::nullopt;
  const bool is_slight = judge::is_slight(
      diagnosis->what,
      judge::lateness_of(judge::truth_of(0, verdict), reply->answer, standard_.terms));
  if (is_slight != finding_.is_slight) return std::nullopt;
  return failing_case(query, reply->answer, verdict, diagnosis->detail, finding_.generator);
}

std::optional<Recheck::Reply> Recheck::reply_to(const AnyQuery& query,
                                                const base::Deadline& deadline) {
  if (of_judge_) {
    fast::CertifiedResult result;
    fast::solve(query.queries(), {&result, 1}, {.separation = separation_, .max_threads = 1});
    return Reply{.answer = answer_of(result), .failure = std::nullopt};
  }
  Reply reply;
  const solvers::SolverRun run = solver_.solve(query.queries(), {&reply.answer, 1}, method_options_,
                                               {.end = solver_deadline(deadline)});
  if (run.answered == 0) return std::nullopt;
  if (!run.failures.empty()) reply.failure = run.failures.front().failure;
  return reply;
}

std::optional<Diagnosis> Recheck::diagnose_reply(const AnyQuery& query,
                                                 const judge::GroundTruth& truth,
                                                 const Reply& reply) const {
  if (reply.failure) return diagnose_failure(*reply.failure, query_limit_seconds_);
  if (finding_.missing.any() && reply.answer.verdict == Verdict::yes &&
      lacks_same_bounds(reply.answer, finding_.original.answer)) {
    return Diagnosis{judge::Fault::not_finite, finding_.original.detail};
  }
  return diagnose({query.queries(), separation_}, truth, reply.answer, standard_);
}

bool Recheck::is_same(const Diagnosis& diagnosis) const {
  return diagnosis.what == finding_.what || finding_.what == judge::Fault::asymmetry;
}

void simplify(const fast::Method& method, const FuzzOptions& options,
              const base::Deadline& deadline, Finding& finding) {
  // In less time than that no query can be seen to hang.
  const bool is_hang = finding.what == judge::Fault::hang;
  if (is_hang && deadline.seconds_left() <= options.query_limit_seconds) return;
  Recheck recheck(method, finding, options);
  const auto must_end = [&] { return deadline.is_over() || base::is_stopped(options.stop); };
  const auto fails = [&](const AnyQuery& query) {
    std::optional<FailingCase> evidence = recheck.ask(query, deadline);
    if (evidence) finding.simplest = std::move(*evidence);
    return evidence.has_value();
  };
  // A query that ended the process or took too long was asked alone before.
  if (!is_confirmed_alone(finding.what) && !fails(finding.original.query)) {
    finding.shrinking = must_end() ? Shrinking::cut_short : Shrinking::not_reproduced;
    return;
  }
  static_cast<void>(shrink(finding.original.query, fails, {.must_end = must_end}));
  finding.shrinking = must_end() ? Shrinking::cut_short : Shrinking::complete;
}

}  // namespace touchstone::verify::fuzz

#include "verify/fuzz/recheck.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/fuzz/shrink.hpp"
#include "verify/judge/claimed_distance.hpp"
#include "verify/judge/separation_inference.hpp"
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

/// Empty where it would exceed the format's limits.
std::string certificate(const AnyQuery& query, const exact::Decision& verdict,
                        std::string_view label) {
  try {
    return exact::certificate_stream(base::prove(query.queries(), 0, verdict), label);
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
  const exact::Decision verdict = base::decide(query.queries(), 0, separation_);
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
    base::solve(query.queries(), {&result, 1}, {.separation = separation_, .max_threads = 1});
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
  static_cast<void>(shrink(finding.original.query, fails, must_end));
  finding.shrinking = must_end() ? Shrinking::cut_short : Shrinking::complete;
}

namespace {

using fast::Answer;
using fast::CertifiedResult;
using fast::Verdict;
using judge::Fault;

/// The first of the faults that breaks the promise.
std::optional<Fault> broken(const std::vector<Fault>& faults, fast::Promise promise) {
  const auto first =
      std::ranges::find_if(faults, [&](Fault fault) { return judge::breaks(fault, promise); });
  if (first == faults.end()) return std::nullopt;
  const bool is_undecided = *first == Fault::false_positive && faults.front() == Fault::undecided;
  return is_undecided ? Fault::undecided : *first;
}

std::string late_text(const judge::GroundTruth& truth, const Answer& answer,
                      const fast::Terms& terms) {
  const judge::Lateness late = judge::lateness_of(truth, answer, terms).value_or(judge::Lateness{});
  return fmt::format("{} {} is late by {:.1e} of the step, {:.0f} ulp",
                     terms.times == fast::Times::estimates ? "estimate" : "toi_lower",
                     answer.toi_lower, late.step, late.ulps);
}

std::string detail_of(Fault what, const judge::Question& question, const judge::GroundTruth& truth,
                      const Answer& answer, const judge::Standard& standard) {
  switch (what) {
    case Fault::no_verdict:
      return "error or no verdict, of a valid query";
    case Fault::false_negative:
      return "no, but they collide";
    case Fault::late_toi:
      return late_text(truth, answer, standard.terms);
    case Fault::early_toi_upper:
      return standard.terms.times == fast::Times::estimates
                 ? fmt::format("estimate {} is early", answer.toi_lower)
                 : fmt::format("toi_upper {} is early", answer.toi_upper);
    case Fault::false_positive:
    case Fault::undecided:
      return to_text(answer) + ", but they do not collide, and it promises exactness";
    case Fault::beyond_tolerance:
      return fmt::format("{}, but they never come within {}, as this claims", to_text(answer),
                         judge::to_text(judge::claim_of(question, answer, standard).value()));
    default:
      return to_text(answer);
  }
}

}  // namespace

bool is_beyond_doubt(const judge::Question& question, const CertifiedResult& judged,
                     const Answer& answer, const judge::Standard& standard) {
  if (judged.verdict == Verdict::error) return false;
  judge::GroundTruth truth{.index = 0, .collides = judged.verdict == Verdict::yes, .toi = {}};
  if (truth.collides) truth.toi = exact::DoubleInterval{judged.toi_lower, judged.toi_upper};
  if (broken(judge::judge_verdict(truth, answer, standard.terms), standard.promise)) return false;
  if (truth.collides) return true;
  const auto claimed = judge::claim_of(question, answer, standard);
  if (!claimed) return true;
  const ContactKind kind = question.query.kind.contact();
  const Query& query = question.query.straight().front();
  return (claimed->norm == Norm::linf &&
          judge::is_seen_within(kind, query, answer.toi_lower, claimed->distance)) ||
         fast::solve(kind, query, {.separation = *claimed}).verdict == Verdict::yes;
}

std::optional<Diagnosis> diagnose(const judge::Question& question, const judge::GroundTruth& truth,
                                  const Answer& answer, const judge::Standard& standard) {
  const auto what = broken(judge::judge(question, truth, answer, standard), standard.promise);
  if (!what) return std::nullopt;
  return Diagnosis{*what, detail_of(*what, question, truth, answer, standard)};
}

Diagnosis diagnose_failure(const judge::Failure& failure, double limit_seconds) {
  switch (failure.kind) {
    case Fault::hang:
      return {failure.kind, fmt::format("takes more than {} s", limit_seconds)};
    case Fault::no_verdict:
      return {failure.kind, "error or no verdict, of a valid query"};
    default:
      return {failure.kind, judge::to_text(failure)};
  }
}

std::string to_text(const Answer& answer) {
  std::string text(judge::to_string(answer.verdict));
  const auto add = [&text](std::string_view name, double value) {
    if (!std::isnan(value)) text += fmt::format(", {} {}", name, value);
  };
  add("toi_lower", answer.toi_lower);
  add("toi_upper", answer.toi_upper);
  add("tolerance", answer.tolerance);
  return text;
}

Signature signature_of(const Finding& finding) {
  return {.method = finding.method,
          .what = finding.what,
          .is_slight = finding.is_slight,
          .kind = finding.kind(),
          .shape = shape_of(finding.simplest.query)};
}

}  // namespace touchstone::verify::fuzz

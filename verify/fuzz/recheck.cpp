#include "verify/fuzz/recheck.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/fuzz/plainness.hpp"
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
  const Kind kind = question.query.kind;
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

namespace {

/// Binary exponents of the greatest coordinate to ask at: close to 1 each, then fewer.
constexpr std::array scales_to_ask{-40, -30, -24, -20, -17, -14, -12, -10, -8, -7, -6,
                                   -5,  -4,  -3,  -2,  -1,  0,   1,   2,   3,  4,  5,
                                   6,   7,   8,   10,  12,  14,  17,  20,  24, 30, 40};

/// True if it has a reason that tells one fault from another.
bool has_reason(judge::Fault what) {
  return what == judge::Fault::crash || what == judge::Fault::exit ||
         what == judge::Fault::exception;
}

void add_end(const std::optional<int>& exponent, ScaleEnds& all) {
  if (!exponent) return;
  const bool is_below = *exponent < least_everyday;
  const bool is_above = *exponent > greatest_everyday;
  all.below_everyday = all.below_everyday || is_below;
  all.above_everyday = all.above_everyday || is_above;
  all.everyday = all.everyday || (!is_below && !is_above);
}

ContactTime time_of(const FailingCase& failing) {
  if (!failing.toi) return ContactTime::never;
  if (failing.toi->upper == 0.0) return ContactTime::at_start;
  return failing.toi->lower == 1.0 ? ContactTime::at_end : ContactTime::between;
}

Shape shape_of(const AnyQuery& query) {
  if (collapsed_elements(query) != 0) return Shape::collapsed;
  return degeneracy(query) != 0 ? Shape::coplanar : Shape::general;
}

}  // namespace

int least_scale(double tolerance) {
  constexpr int margin = 4;
  // In this form NaN and 0 fail, too.
  if (!(tolerance > 0x1p-44)) return scales_to_ask.front();
  return std::min(std::ilogb(tolerance) + margin, 0);
}

ScaleRange scale_range(const fast::Method& method, const FuzzOptions& options,
                       const base::Deadline& deadline, const Finding& finding) {
  if (finding.what == judge::Fault::hang || !is_zero(finding.separation)) return {};
  const AnyQuery& query = finding.simplest.query;
  const int exponent = size_exponent(query), least = least_scale(options.method.tolerance);
  Recheck recheck(method, finding, options);
  const auto is_right_at = [&](int scale) {
    AnyQuery scaled = query;
    for_each_coordinate(scaled, point_axes,
                        [&](double& x) { x = std::ldexp(x, scale - exponent); });
    // A missing answer at the deadline proves nothing.
    return !recheck.ask(scaled, deadline) && !deadline.is_over();
  };
  ScaleRange result;
  const std::vector<int> downwards(scales_to_ask.rbegin(), scales_to_ask.rend());
  for (const int scale : downwards) {
    if (result.end_below || scale < least) break;
    if (scale < exponent && is_right_at(scale)) result.end_below = scale;
  }
  for (const int scale : scales_to_ask) {
    if (scale <= exponent || !is_right_at(scale)) continue;
    result.end_above = scale;
    break;
  }
  return result;
}

Signature signature_of(const Finding& finding) {
  const FailingCase& simplest = finding.simplest;
  Signature result{.method = finding.method, .what = finding.what, .is_slight = finding.is_slight};
  if (has_reason(finding.what)) result.reason = simplest.detail;
  add_end(finding.scales.end_below, result.ends);
  add_end(finding.scales.end_above, result.ends);
  if (result.ends.any()) return result;
  result.kind = finding.kind();
  // The query of a hang is not simplified, and gives no hint of the cause.
  if (finding.what == judge::Fault::hang) return result;
  result.shape = shape_of(simplest.query);
  result.is_on_curves = !simplest.query.shape().is_straight();
  result.time = time_of(simplest);
  return result;
}

std::string to_text(const ScaleEnds& scales) {
  if (!scales.any()) return "any scale";
  std::string text;
  const auto add = [&text](bool is_there, const char* words) {
    if (is_there) text += (text.empty() ? "ends " : " and ") + std::string(words);
  };
  add(scales.below_everyday, "below 2^-10");
  add(scales.everyday, "near 1");
  add(scales.above_everyday, "above 2^10");
  return text;
}

std::string to_text(const std::optional<ContactTime>& time) {
  static constexpr std::array<const char*, 4> names{"none", "t=0", "between", "t=1"};
  return time ? names.at(static_cast<std::size_t>(*time)) : "any";
}

std::string to_text(const std::optional<Shape>& shape) {
  static constexpr std::array<const char*, 3> names{"general", "coplanar", "collapsed"};
  return shape ? names.at(static_cast<std::size_t>(*shape)) : "any";
}

}  // namespace touchstone::verify::fuzz

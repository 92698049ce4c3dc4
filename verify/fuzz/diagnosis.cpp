#include "verify/fuzz/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "verify/judge/claimed_distance.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::fuzz {
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

}  // namespace touchstone::verify::fuzz

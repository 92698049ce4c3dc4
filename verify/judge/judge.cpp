#include "verify/judge/judge.hpp"

#include "touchstone/oracle.hpp"
#include "verify/judge/claimed_distance.hpp"

namespace touchstone::verify::judge {
namespace {

bool is_beyond(const Question& question, const fast::Answer& answer, const Separation& claimed) {
  const auto& [kind, query, separation] = question;
  const bool is_seen =
      claimed.norm == Norm::linf && is_seen_within(kind, query, answer.toi_lower, claimed.distance);
  return !is_seen && !exact::decide(kind, query, claimed).collides();
}

}  // namespace

Standard standard_of(const fast::MethodInfo& info) {
  return {.promise = info.promise, .filter = info.filter};
}

std::vector<Fault> judge(const Question& question, const GroundTruth& truth,
                         const fast::Answer& answer, const Standard& standard,
                         const Failure* failure) {
  std::vector<Fault> faults = judge_verdict(truth, answer, failure);
  if (truth.collides || failure != nullptr || failure_of(answer)) return faults;
  const std::optional<Separation> claimed = claim_of(question, answer, standard);
  if (claimed && is_beyond(question, answer, *claimed)) faults.push_back(Fault::beyond_tolerance);
  return faults;
}

std::vector<Fault> judge_verdict(const GroundTruth& truth, const fast::Answer& answer,
                                 const Failure* failure) {
  using fast::Verdict;
  std::vector<Fault> faults;
  Verdict verdict = answer.verdict;
  if (const auto why = failure != nullptr ? std::optional(*failure) : failure_of(answer)) {
    faults.push_back(why->kind);
    verdict = verdict_of(why->kind);
  }
  if (verdict == Verdict::error) return faults;
  if (!truth.collides) {
    if (verdict != Verdict::no) faults.push_back(Fault::false_positive);
    return faults;
  }
  if (verdict == Verdict::no) faults.push_back(Fault::false_negative);
  if (verdict != Verdict::yes) return faults;
  const auto [lower, upper] = truth.toi.value();
  // No comparison holds for a NaN, which marks a missing field.
  if (answer.toi_lower > lower) faults.push_back(Fault::late_toi);
  if (answer.toi_upper < upper) faults.push_back(Fault::early_toi_upper);
  return faults;
}

std::optional<Separation> claim_of(const Question& question, const fast::Answer& answer,
                                   const Standard& standard) {
  if (answer.verdict != fast::Verdict::yes) return std::nullopt;
  const Separation claimed =
      claimed_distance(standard.filter, question.kind, question.query, answer, question.separation);
  return is_valid(claimed) ? std::optional(claimed) : std::nullopt;
}

bool breaks(Fault fault, fast::Promise promise) {
  switch (fault) {
    case Fault::false_positive:
      return promise == fast::Promise::exact;
    case Fault::hang:
    case Fault::undecided:
      return false;
    default:
      return true;
  }
}

}  // namespace touchstone::verify::judge

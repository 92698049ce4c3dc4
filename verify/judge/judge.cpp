#include "verify/judge/judge.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "touchstone/oracle.hpp"
#include "verify/judge/claimed_distance.hpp"

namespace touchstone::verify::judge {
namespace {

bool is_beyond(const Question& question, const fast::Answer& answer, const Separation& claimed) {
  const ContactKind kind = question.query.kind.contact();
  const Query& query = question.query.straight().front();
  const bool is_seen =
      claimed.norm == Norm::linf && is_seen_within(kind, query, answer.toi_lower, claimed.distance);
  return !is_seen && !exact::decide(kind, query, claimed).collides();
}

/// The number of a double among all in their order, up to a constant.
std::int64_t ordinal(double x) {
  const auto bits = std::bit_cast<std::int64_t>(x);
  return bits < 0 ? INT64_MIN - bits : bits;
}

/// The time of an answer as it is given: the lower bound, or the estimate.
double given_time(const fast::Answer& answer, const fast::Terms& terms) {
  if (terms.times == fast::Times::none) return fast::Answer::none;
  const bool is_upper = terms.times == fast::Times::estimates && std::isnan(answer.toi_lower);
  return is_upper ? answer.toi_upper : answer.toi_lower;
}

/// The worst first.
constexpr std::array by_harm{
    Fault::false_negative, Fault::late_toi,   Fault::early_toi_upper, Fault::beyond_tolerance,
    Fault::false_positive, Fault::asymmetry,  Fault::crash,           Fault::exit,
    Fault::exception,      Fault::no_verdict, Fault::not_finite,      Fault::hang,
    Fault::undecided};
static_assert(by_harm.size() == fault_count);

}  // namespace

Standard standard_of(const fast::MethodInfo& info) {
  return {.promise = info.promise, .filter = info.filter, .terms = info.terms};
}

std::vector<Fault> judge(const Question& question, const GroundTruth& truth,
                         const fast::Answer& answer, const Standard& standard,
                         const Failure* failure) {
  std::vector<Fault> faults = judge_verdict(truth, answer, standard.terms, failure);
  if (truth.collides || failure != nullptr || failure_of(answer)) return faults;
  const std::optional<Separation> claimed = claim_of(question, answer, standard);
  if (claimed && is_beyond(question, answer, *claimed)) faults.push_back(Fault::beyond_tolerance);
  return faults;
}

std::vector<Fault> judge_verdict(const GroundTruth& truth, const fast::Answer& answer,
                                 const fast::Terms& terms, const Failure* failure) {
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
  const fast::Answer claimed = with_claimed_bounds(answer, terms);
  // No comparison holds for a NaN, which marks a missing field.
  if (claimed.toi_lower > lower) faults.push_back(Fault::late_toi);
  if (claimed.toi_upper < upper) faults.push_back(Fault::early_toi_upper);
  return faults;
}

fast::Answer with_claimed_bounds(const fast::Answer& answer, const fast::Terms& terms) {
  if (terms.times == fast::Times::bounds) return answer;
  const double time = given_time(answer, terms);
  fast::Answer claimed = answer;
  claimed.toi_lower = time - terms.time_error;
  claimed.toi_upper = time + terms.time_error;
  return claimed;
}

std::optional<Lateness> lateness_of(const GroundTruth& truth, const fast::Answer& answer,
                                    const fast::Terms& terms) {
  if (!truth.collides || answer.verdict != fast::Verdict::yes) return std::nullopt;
  const double time = given_time(answer, terms), exact = truth.toi.value().lower;
  if (!(time > exact) || std::isinf(time)) return std::nullopt;
  return Lateness{.step = time - exact,
                  .ulps = static_cast<double>(ordinal(time) - ordinal(exact))};
}

bool is_slight(Fault fault, const std::optional<Lateness>& lateness) {
  return fault == Fault::late_toi && lateness && lateness->step <= slight_lateness;
}

std::optional<Separation> claim_of(const Question& question, const fast::Answer& answer,
                                   const Standard& standard) {
  const bool has_distance = question.query.is_straight() && !question.query.kind.is_cell();
  if (answer.verdict != fast::Verdict::yes || !has_distance) return std::nullopt;
  const Separation claimed =
      claimed_distance(standard.filter, question.query.kind.contact(),
                       question.query.straight().front(), answer, question.separation);
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

int harm_of(Fault fault, bool is_slight, fast::Promise promise) {
  // A slightly late time comes before the failures.
  constexpr Fault behind_slight = Fault::crash;
  const auto place = [](Fault wanted) {
    return static_cast<int>(std::ranges::find(by_harm, wanted) - by_harm.begin());
  };
  const int rank = is_slight ? 2 * place(behind_slight) - 1 : 2 * place(fault);
  return breaks(fault, promise) ? rank : rank + 2 * static_cast<int>(by_harm.size());
}

}  // namespace touchstone::verify::judge

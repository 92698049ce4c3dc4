#include "verify/fuzz/diagnosis.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "exact/oracle.hpp"
#include "verify/judge/claimed_distance.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/answers.hpp"

namespace touchstone::verify::fuzz {
namespace {

using fast::Answer;
using fast::CertifiedResult;
using fast::Promise;
using fast::Verdict;

/// Of a yes: an infinite bound, or an invalid tolerance. (NaN says: not given.)
bool has_bad_number(const Answer& answer) {
  return std::isinf(answer.toi_lower) || std::isinf(answer.toi_upper) || answer.tolerance < 0.0;
}

/// The distance that a yes claims, if it claims one.
std::optional<Separation> claim_of(Kind kind, const Query& query, const Answer& answer,
                                   const Standard& standard) {
  const Separation claimed =
      judge::claimed_distance(standard.filter, kind, query, answer, standard.separation);
  return is_valid(claimed) ? std::optional(claimed) : std::nullopt;
}

/// Of a yes to what does not collide; what collides is near enough for any claim.
std::optional<Diagnosis> tolerance_fault(Kind kind, const Query& query, const Answer& answer,
                                         const Standard& standard) {
  const std::optional<Separation> claimed = claim_of(kind, query, answer, standard);
  if (!claimed || exact::decide(kind, query, *claimed).collides()) return std::nullopt;
  return Diagnosis{judge::Fault::beyond_tolerance,
                   fmt::format("{}, but they never come within {}, as that claims", to_text(answer),
                               judge::to_text(*claimed))};
}

std::optional<Diagnosis> toi_fault(const judge::GroundTruth& truth, const Answer& answer) {
  const auto [lower, upper] = truth.toi.value();
  // The enclosure's ends are neighbouring doubles, or one: these comparisons are exact.
  if (answer.toi_lower > lower) {
    return Diagnosis{judge::Fault::late_toi, fmt::format("toi_lower {} is late", answer.toi_lower)};
  }
  if (answer.toi_upper < upper) {
    return Diagnosis{judge::Fault::early_toi_upper,
                     fmt::format("toi_upper {} is early", answer.toi_upper)};
  }
  return std::nullopt;
}

}  // namespace

bool is_beyond_doubt(Kind kind, const Query& query, const CertifiedResult& judged,
                     const Answer& answer, const Standard& standard) {
  if (answer.verdict == Verdict::error || judged.verdict == Verdict::error) return false;
  const bool is_yes = answer.verdict == Verdict::yes;
  if (is_yes && has_bad_number(answer)) return false;
  if (judged.verdict == Verdict::no) {
    if (answer.verdict == Verdict::no) return true;
    if (standard.promise == Promise::exact) return false;
    if (!is_yes) return true;
    const std::optional<Separation> claimed = claim_of(kind, query, answer, standard);
    return !claimed ||
           (claimed->norm == Norm::linf &&
            judge::is_seen_within(kind, query, answer.toi_lower, claimed->distance)) ||
           fast::certified(kind, query, {.separation = *claimed}).verdict == Verdict::yes;
  }
  if (answer.verdict == Verdict::no) return false;
  if (!is_yes) return true;
  // No comparison holds of a NaN.
  return !(answer.toi_lower > judged.toi_lower) && !(answer.toi_upper < judged.toi_upper);
}

std::optional<Diagnosis> diagnose(Kind kind, const Query& query, const judge::GroundTruth& truth,
                                  const Answer& answer, const Standard& standard) {
  if (answer.verdict == Verdict::error)
    return diagnose_failure(judge::failure_of(answer).value(), 0.0);
  if (answer.verdict == Verdict::yes && has_bad_number(answer)) {
    return Diagnosis{judge::Fault::not_finite, to_text(answer)};
  }
  if (truth.collides) {
    if (answer.verdict == Verdict::no) {
      return Diagnosis{judge::Fault::false_negative, "no, but they collide"};
    }
    return answer.verdict == Verdict::yes ? toi_fault(truth, answer) : std::nullopt;
  }
  if (answer.verdict == Verdict::no) return std::nullopt;
  if (standard.promise == Promise::exact) {
    return Diagnosis{
        answer.verdict == Verdict::yes ? judge::Fault::false_positive : judge::Fault::undecided,
        to_text(answer) + ", but they do not collide, and it promises exactness"};
  }
  return answer.verdict == Verdict::yes ? tolerance_fault(kind, query, answer, standard)
                                        : std::nullopt;
}

Diagnosis diagnose_failure(const judge::Failure& failure, double limit_seconds) {
  const judge::Fault what = finding_kind_of(failure.kind);
  switch (failure.kind) {
    case judge::Fault::hang:
      return {what, fmt::format("takes more than {} s", limit_seconds)};
    case judge::Fault::no_verdict:
      return {what, "error or no verdict, of a valid query"};
    default:
      return {what, solvers::to_text(failure)};
  }
}

std::optional<Diagnosis> diagnose_judge(const judge::GroundTruth& truth,
                                        const CertifiedResult& judged) {
  const Answer answer{.verdict = judged.verdict,
                      .toi_lower = judged.toi_lower,
                      .toi_upper = judged.toi_upper,
                      .tolerance = Answer::none};
  return diagnose(Kind::vertex_face, {}, truth, answer, {.promise = Promise::exact});
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

#pragma once

/// \file
/// Right or wrong: one answer held against the truth.
///
/// The certified solver decides blocks of queries at speed. Its verdicts and enclosures tell at
/// once that most answers are right; the others are *doubtful*, and only the oracle says of them
/// that they are wrong. So a fault of the judge costs a finding, which the oracle's share of all
/// queries brings to light, and no correct solver is reported.

#include <optional>
#include <string>

#include "exact/query.hpp"
#include "fast/certified.hpp"
#include "fast/method.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::fuzz {

/// The promise and separation that a solver is judged by.
struct Standard {
  fast::Promise promise = fast::Promise::conservative;
  Separation separation = {};
  /// The filter that its tolerances do not include (fast::MethodInfo::filter).
  std::optional<fast::ErrorModel> filter = std::nullopt;
};

/// The kind of fault, and a description.
struct Diagnosis {
  judge::Fault what;
  std::string detail;
};

/// Is there nothing in the answer that could be wrong, by what the certified solver found? If not,
/// it may still be right.
[[nodiscard]] bool is_beyond_doubt(Kind kind, const Query& query,
                                   const fast::CertifiedResult& judged, const fast::Answer& answer,
                                   const Standard& standard);

/// The fault of the answer to a valid query, if it has one:
/// - no_verdict: the verdict is `error`;
/// - not_finite: yes with an infinite bound, or a tolerance below 0;
/// - false_negative: no, but they collide;
/// - false_positive, undecided: though they do not collide, of what promises exactness;
/// - beyond_tolerance: yes, but they never come as near as its tolerance claims;
/// - late_toi, early_toi_upper: yes with a bound on the wrong side of the exact time of impact.
/// \param truth of the query at the standard's separation
[[nodiscard]] std::optional<Diagnosis> diagnose(Kind kind, const Query& query,
                                                const judge::GroundTruth& truth,
                                                const fast::Answer& answer,
                                                const Standard& standard);

/// The fault of a solver that gave no answer, or an impossible one.
/// \param limit_seconds that a query may take
[[nodiscard]] Diagnosis diagnose_failure(const judge::Failure& failure, double limit_seconds);

/// Does the oracle's truth contradict what the certified solver found?
[[nodiscard]] std::optional<Diagnosis> diagnose_judge(const judge::GroundTruth& truth,
                                                      const fast::CertifiedResult& judged);

/// "no", "yes, toi_lower 0.5, tolerance 1e-06": the verdict and the fields that are given.
[[nodiscard]] std::string to_text(const fast::Answer& answer);

}  // namespace touchstone::verify::fuzz

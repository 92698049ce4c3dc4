#pragma once

/// \file
/// The faults of one answer as the fuzzer looks for them (verify/judge/judge.hpp): quickly first,
/// then for certain.
///
/// The certified solver decides blocks of queries at speed. Its verdicts and enclosures show at
/// once that most answers are right; the others are *doubtful*, and only the oracle finds them
/// wrong. A fault of the certified solver can therefore hide a finding, which the oracle's share of
/// all queries brings to light, but no correct solver is reported.

#include <optional>
#include <string>

#include "fast/method.hpp"
#include "verify/judge/judge.hpp"
#include "verify/solvers/answers.hpp"

namespace touchstone::verify::fuzz {

/// A fault that breaks the promise of a solver, and a description.
struct Diagnosis {
  judge::Fault what;
  std::string detail;
};

/// True if the certified solver's result shows that nothing in the answer breaks the promise. An
/// answer that is not beyond doubt may still be right.
[[nodiscard]] bool is_beyond_doubt(const judge::Question& question,
                                   const fast::CertifiedResult& judged, const fast::Answer& answer,
                                   const judge::Standard& standard);

/// The first fault of an answer to a valid query that breaks the promise, if there is one. An
/// undecided that breaks a promise of exactness is called undecided.
/// \param truth of the query at the separation
[[nodiscard]] std::optional<Diagnosis> diagnose(const judge::Question& question,
                                                const judge::GroundTruth& truth,
                                                const fast::Answer& answer,
                                                const judge::Standard& standard);

/// The fault of a solver that gave no answer, or an impossible one.
/// \param limit_seconds that a query may take
[[nodiscard]] Diagnosis diagnose_failure(const judge::Failure& failure, double limit_seconds);

using solvers::answer_of;

/// "no", "yes, toi_lower 0.5, tolerance 1e-06": the verdict and the fields that are given.
[[nodiscard]] std::string to_text(const fast::Answer& answer);

}  // namespace touchstone::verify::fuzz

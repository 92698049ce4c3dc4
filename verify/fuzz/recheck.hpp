#pragma once

/// \file
/// Asks a solver again after a finding: for a simpler query with the same fault, and for the
/// evidence.

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/certified.hpp"
#include "verify/base/any_query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judge.hpp"
#include "verify/solvers/answers.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify::fuzz {

// The faults of one answer as the fuzzer looks for them (verify/judge/judge.hpp): quickly first,
// then for certain.
//
// The certified solver decides blocks of queries at speed. Its verdicts and enclosures show at
// once that most answers are right; the others are *doubtful*, and only the oracle finds them
// wrong. A fault of the certified solver can therefore hide a finding, which the oracle's share of
// all queries brings to light, but no correct solver is reported.

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

using base::AnyQuery;

/// The name of the solver that judges the others.
[[nodiscard]] inline std::string_view judge_name() { return fast::certified_info().name; }

/// The standard that a method is judged by in a run.
[[nodiscard]] judge::Standard standard_of(const fast::Method& method, const FuzzOptions& options);

/// Options of a solver's process in a run.
[[nodiscard]] solvers::SolverProcessOptions process_options(const FuzzOptions& options);

/// The deadline of the solver's process: the seconds left, by the system's clock, at least a
/// millisecond.
[[nodiscard]] base::Deadline solver_deadline(const base::Deadline& deadline);

/// The evidence of a fault. \param verdict of the query, at the run's separation
[[nodiscard]] FailingCase failing_case(AnyQuery query, const fast::Answer& answer,
                                       const exact::Decision& verdict, std::string detail,
                                       std::string_view label);

/// Tests whether a solver has the same fault at another query. Each call asks the solver about this
/// query alone, in a child process, and the oracle. For a finding by an image of a query any fault
/// counts as the same. For a finding against the judge, the judge is asked.
class Recheck {
 public:
  /// \param options those of the run that found it
  /// The method must live as long as this object.
  Recheck(const fast::Method& method, const Finding& finding, const FuzzOptions& options);

  /// The evidence, if the solver has the fault; nothing if it has not, or has not answered by the
  /// deadline, or the query is not valid.
  [[nodiscard]] std::optional<FailingCase> ask(const AnyQuery& query,
                                               const base::Deadline& deadline = {});

 private:
  /// The solver's answer to this query alone, or the reason why there is none.
  struct Reply {
    fast::Answer answer;
    std::optional<judge::Failure> failure;
  };
  [[nodiscard]] std::optional<Reply> reply_to(const AnyQuery& query,
                                              const base::Deadline& deadline);
  [[nodiscard]] std::optional<Diagnosis> diagnose_reply(const AnyQuery& query,
                                                        const judge::GroundTruth& truth,
                                                        const Reply& reply) const;
  [[nodiscard]] bool is_same(const Diagnosis& diagnosis) const;

  Finding finding_;
  judge::Standard standard_;
  Separation separation_;
  double query_limit_seconds_;
  bool of_judge_;
  solvers::SolverProcess solver_;
  fast::MethodOptions method_options_;
};

/// Simplifies the finding's query while the solver has the same fault at it (shrink.hpp), until the
/// deadline or the options' stop. The query of a hang that takes longer is left as it is.
void simplify(const fast::Method& method, const FuzzOptions& options,
              const base::Deadline& deadline, Finding& finding);

/// What findings of one group have in common: the wrong solver, the fault, and kind and degeneracy
/// of the simplest query (plainness.hpp). This is no proof of one cause: two faults may have one
/// signature, and one fault two.
struct Signature {
  std::string method;
  judge::Fault what = judge::Fault::false_negative;
  bool is_slight = false;  ///< true for a time that is late slightly
  AnyKind kind = ContactKind::vertex_face;
  Shape shape = Shape::general;

  // clang-tidy 14 takes the comparison of the bool for a conversion.
  // NOLINTNEXTLINE(readability-implicit-bool-conversion)
  friend auto operator<=>(const Signature&, const Signature&) = default;
};

[[nodiscard]] Signature signature_of(const Finding& finding);

}  // namespace touchstone::verify::fuzz

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
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"
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

// The signs by which findings of one cause are recognized from outside.
//
// A fault of rounding depends on the scale: if its query is multiplied by powers of two, which
// changes nothing else, the answer is right at some scales, and these tell one wrong bound from
// another. It shows in queries of any shape and time, of both kinds. A fault of logic does not
// depend on the scale; it shows in one kind of queries, of one degeneracy, at one time of contact.
// Findings therefore are of one group if they are of one solver and kind of finding, and
//
// - the fault ends in the same ranges of scale, if it ends anywhere, or else
// - kind, degeneracy (plainness.hpp) and time of contact are the same, and both or none are on
//   curves; of hangs the kind alone.
//
// This is no proof: two faults may have one signature, and one fault two.

/// The time at which the primitives touch first.
enum class ContactTime : std::uint8_t { never, at_start, between, at_end };

/// The elements of a query, and its points' plane.
enum class Shape : std::uint8_t { general, coplanar, collapsed };

/// Ranges of the greatest coordinate in which a fault ends.
struct ScaleEnds {
  bool below_everyday = false;  ///< below 2^-10
  bool everyday = false;
  bool above_everyday = false;  ///< from 2^10 on

  [[nodiscard]] bool any() const { return below_everyday || everyday || above_everyday; }
  // NOLINTNEXTLINE(readability-implicit-bool-conversion): in the comparison of two of them
  friend auto operator<=>(const ScaleEnds&, const ScaleEnds&) = default;
};

/// The signature, as above. For a fault that depends on the scale, kind, shape, time and curves are
/// not set.
struct Signature {
  std::string method;
  judge::Fault what = judge::Fault::false_negative;
  bool is_slight = false;  ///< true for a time that is late slightly
  /// The reason of a crash, an exit or an exception; else empty.
  std::string reason = {};
  ScaleEnds ends = {};
  std::optional<Kind> kind = std::nullopt;
  std::optional<Shape> shape = std::nullopt;
  std::optional<ContactTime> time = std::nullopt;
  bool is_on_curves = false;

  // clang-tidy 14 takes the comparison of the bool for a conversion.
  // NOLINTNEXTLINE(readability-implicit-bool-conversion)
  friend auto operator<=>(const Signature&, const Signature&) = default;
};

inline constexpr int greatest_scale = 40;

/// The least scale that is asked, -40 or more. Below 16 times the tolerance of the solvers all
/// points are close to each other.
[[nodiscard]] int least_scale(double tolerance);

/// The scales at which the finding's simplest query is wrong, around its own: it is asked again
/// times powers of two, up and down, until it is right or the greatest coordinate is beyond
/// 2^least_scale() to 2^greatest_scale. For a hang, and for findings about a separation, nothing is
/// asked, and no end is known.
[[nodiscard]] ScaleRange scale_range(const fast::Method& method, const FuzzOptions& options,
                                     const base::Deadline& deadline, const Finding& finding);

/// The signature of a finding's simplest query. \pre its scales are known
[[nodiscard]] Signature signature_of(const Finding& finding);

/// "ends near 1", "ends at large scales", "any scale" and so on.
[[nodiscard]] std::string to_text(const ScaleEnds& scales);

/// "t=0", "t=1", "between", "none"; "any" if it is not set.
[[nodiscard]] std::string to_text(const std::optional<ContactTime>& time);

/// "general", "coplanar", "collapsed"; "any" if it is not set.
[[nodiscard]] std::string to_text(const std::optional<Shape>& shape);

}  // namespace touchstone::verify::fuzz

#pragma once

/// \file
/// The judge: the one place where an answer is found right or wrong. Every job, page and printed
/// program has its faults from here. Labels are judged beside it (label.hpp).
///
/// - A yes and an undecided both mean "take it for a collision"; so an undecided is never a false
///   negative, and one about a query that does not collide is a false positive, as a yes is.
/// - Truth is about the separation that was asked for, in the norm that was asked for.
/// - A query with an error has no further faults; a hang counts as undecided.
/// - The truth is that of the query as the solver is asked it (terms.hpp); queries outside of its
///   terms are not judged.
/// - Times of impact are judged for a yes to a query that does collide, and only where the solver
///   gives them. An estimate t of the time with an error e claims the bounds t − e and t + e. All
///   comparisons are exact: the truth is enclosed by neighbouring doubles, or is one, so a double t
///   is above it iff t > lower, and below it iff t < upper.
/// - The tolerance is judged for a yes to a query on straight lines that does not collide: a
///   colliding pair satisfies any claimed distance. A cell has no distance.
/// - A cell that inverts collides, and the first time at which its volume is not positive is its
///   time of impact.

#include <optional>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/judge/fault.hpp"
#include "verify/judge/ground_truth.hpp"

namespace touchstone::verify::judge {

/// A query as it was asked.
struct Question {
  AnyQueries query;  ///< one
  Separation separation = {};
};

/// The promise of a solver, by which its answers are judged.
struct Standard {
  fast::Promise promise = fast::Promise::conservative;
  /// The filter that its tolerances do not include (fast::MethodInfo::filter).
  fast::ErrorFilter filter = nullptr;
  fast::Terms terms = {};
};

/// The standard of a method that makes this promise of itself.
[[nodiscard]] Standard standard_of(const fast::MethodInfo& info);

/// All faults of an answer, a failure first; none if it is right. Some break no promise: see
/// breaks().
/// \param truth of the query at the separation. \pre truth.toi is there if it collides
/// \param failure the reason for a missing answer; null: as the answer shows (failure_of)
[[nodiscard]] std::vector<Fault> judge(const Question& question, const GroundTruth& truth,
                                       const fast::Answer& answer, const Standard& standard,
                                       const Failure* failure = nullptr);

/// The same without beyond_tolerance: the faults of verdict and times, which need nothing but the
/// truth. If the truth is known less closely, correct times may be reported as faults.
[[nodiscard]] std::vector<Fault> judge_verdict(const GroundTruth& truth, const fast::Answer& answer,
                                               const fast::Terms& terms = {},
                                               const Failure* failure = nullptr);

/// The answer with the bounds of the time that it claims under the terms.
[[nodiscard]] fast::Answer with_claimed_bounds(const fast::Answer& answer,
                                               const fast::Terms& terms);

/// The lateness of a time: its distance from the exact time of impact before it.
struct Lateness {
  double step = 0.0;  ///< in units of the step
  double ulps = 0.0;  ///< doubles from the exact time to it
};

/// A lateness up to this, in units of the step, is *slight*: rounding errors, not wrong contacts.
inline constexpr double slight_lateness = 1e-9;

/// The lateness of the time that an answer gives, bound or estimate; nothing if it is not late, or
/// not given, or there is no collision, or no yes. \pre truth.toi is there if it collides
[[nodiscard]] std::optional<Lateness> lateness_of(const GroundTruth& truth,
                                                  const fast::Answer& answer,
                                                  const fast::Terms& terms);

/// True if the fault is a late time, and only slightly late.
[[nodiscard]] bool is_slight(Fault fault, const std::optional<Lateness>& lateness);

/// The separation within which a yes claims that the primitives come, if it claims one: beyond it,
/// the answer is beyond_tolerance.
[[nodiscard]] std::optional<Separation> claim_of(const Question& question,
                                                 const fast::Answer& answer,
                                                 const Standard& standard);

/// True if the fault breaks the promise. Whatever it promises, a solver must have no false
/// negative, no time of impact that excludes the true one, no error, and no yes that claims a
/// smaller distance than the true one; if it promises exactness, also no false positive.
[[nodiscard]] bool breaks(Fault fault, fast::Promise promise);

/// The order of faults by their effect on a simulation, the worst first: those that break the
/// promise before the others; a miss; a late time; an early upper bound; a yes beyond its
/// tolerance; a false positive; an asymmetry; a time that is late slightly; no answer.
[[nodiscard]] int harm_of(Fault fault, bool is_slight, fast::Promise promise);

}  // namespace touchstone::verify::judge

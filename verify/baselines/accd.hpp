#pragma once

/// \file
/// ACCD: additive continuous collision detection ([li2021], as in the public IPC Toolkit).
/// docs/methods.md, section 12.
///
/// After subtraction of the mean displacement, no two points of the primitives approach each other
/// faster than ℓ, the sum of each primitive's greatest displacement. At distance d they therefore
/// do not come within ξ before (d − ξ)/ℓ, and may be moved by a share s = 0.9 of that: times add up
/// to a lower bound of the impact that never passes it. It ends with yes if d − ξ is at most a
/// share 1 − s of its initial value, and with no if the time is above t_max.
///
/// ξ is the distance of fast::MethodOptions::separation; it is Euclidean.
///
/// **Promise.** None: nothing bounds the rounding.
///
/// **Known defects.**
///   - Queries without collision whose gap shrinks to less than a tenth of its initial value are
///     false positives by design. (A vertex that comes from 1 down to 0.05 over a face.)
///   - The first step is taken without a test, and moves are accumulated point by point: errors
///     grow, the computed d may pass below ξ, and the step then goes back.
///   - For two edges at a computed distance within ξ the least distance of their ends is used
///     instead, as for distant and nearly parallel edges: after a step that arrives by rounding
///     they may pass through each other.
///   - Only fast::MethodOptions::max_checks bounds the steps of grazing motion; the answer is then
///     yes, with max_checks as `checks`.
///   - Degenerate triangles can have a distance that is not a number: then it steps in place, up to
///     max_checks.
///
/// **The limited variant** runs on graphics processors and in simulators with a bound of the time:
/// s = 0.8, at most 32 steps, and then *no*. It requires primitives that are farther apart than ξ
/// at t=0. A contact that takes more steps is a false negative within these terms: an approach that
/// is slow beside the motion along the primitives.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solves one query. Uses separation.distance (ξ, Euclidean), max_checks and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, strictly before contact up to rounding; or no. `checks` counts
/// steps.
[[nodiscard]] fast::Answer accd(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The same with 32 steps at most. \pre as accd.
[[nodiscard]] fast::Answer accd_limited(Kind kind, const Query& query,
                                        const fast::MethodOptions& options);

/// The methods `accd` and `accd_limited`, which promise nothing.
[[nodiscard]] std::unique_ptr<fast::Method> accd_method();
[[nodiscard]] std::unique_ptr<fast::Method> accd_limited_method();

}  // namespace touchstone::baselines

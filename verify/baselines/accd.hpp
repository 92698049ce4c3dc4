#pragma once

/// \file
/// ACCD: additive continuous collision detection ([li2021], as in the public IPC Toolkit).
/// docs/methods.md, section 12.
///
/// With the mean displacement taken off, no two points of the primitives approach each other faster
/// than ℓ, the sum of each primitive's greatest displacement. So at distance d they do not come
/// within ξ before (d − ξ)/ℓ, and may be moved by a share s = 0.9 of that: times add up to a lower
/// bound of the impact that never passes it. It ends with yes where d − ξ is at most a share 1 − s
/// of what it was at the start, and with no where the time is above t_max.
///
/// ξ is fast::MethodOptions::min_separation; it is Euclidean.
///
/// **fast::Promise.** None: nothing bounds the rounding.
///
/// **Known defects.**
///   - Misses whose gap shrinks to less than a tenth of what it was at the start are false
///     positives by design. (A vertex that comes from 1 down to 0.05 over a face.)
///   - The first step is taken untested, and moves are added up point by point: errors grow, the
///     computed d may pass below ξ, and the step then goes back.
///   - Two edges at a computed distance within ξ are given the least distance of their ends
///     instead, as if they were far away and nearly parallel: after a step that arrives by rounding
///     they may step through each other.
///   - Grazing motion takes steps without a bound but fast::MethodOptions::max_checks; then the answer is
///     yes, its `checks` max_checks.
///   - Degenerate triangles can have a distance that is not a number: then it steps in place, up to
///     max_checks.

#include <memory>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::baselines {

/// Decides one query. Uses min_separation (ξ, Euclidean), max_checks and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, how far the primitives may go: strictly before contact but for
/// rounding; or no. `checks` counts steps.
[[nodiscard]] fast::Answer accd(Kind kind, const Query& query, const fast::MethodOptions& options);

/// As a method called `accd`, which promises nothing.
[[nodiscard]] std::unique_ptr<fast::Method> accd_method();

}  // namespace touchstone::baselines

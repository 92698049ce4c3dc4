#pragma once

/// \file
/// UIRF: the univariate interval root finder ([redon2002], for linear paths; as compared by
/// [wang2021]). docs/methods.md, section 4.
///
/// The four points are in one plane where f(t) = n(t)·q(t) = 0: n the face's normal, or the product
/// of the edges, q a vector from one primitive to the other. f is evaluated in intervals over
/// intervals of t, bisected earliest first (interval_search.hpp). On an interval narrower than δ
/// divided by the greatest displacement whose f may vanish, an inside test in intervals decides:
/// for vertex-face that the vertex is on the inner side of each edge, for edge-edge that each edge
/// separates the other's ends.
///
/// **Promise.** Conservative: the inside tests are closed and rounded outward, so they hold at
/// every contact. Intervals come in ascending order, so the lower end of the accepted one is not
/// above the time of impact.
///
/// **Known defects.**
///   - Nothing bounds u and v: the inside test is as coarse as the motion of the points in that
///     interval.
///   - Degenerate triangles and edges on a line make every product contain 0, and all passes: false
///     positives. The same holds for a motion in one plane wherever the inside test is near 0. (Two
///     edges on one line, far from each other, at rest.)
///   - A pair at rest has no tolerance to reach: [0,1] itself is decided.
///   - f ≡ 0, motion in one plane, makes every interval a candidate: as many checks as there are
///     small intervals. fast::MethodOptions::max_checks bounds them; the answer is then undecided,
///     with max_checks as `checks`.
///   - It does not support a minimum separation: queries that only come within one are false
///     negatives.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solves one query. Uses tolerance (δ, in units of the coordinates), max_checks and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, or no, or undecided once max_checks are spent.
[[nodiscard]] fast::Answer uirf(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The method `uirf`, which promises to be conservative.
[[nodiscard]] std::unique_ptr<fast::Method> uirf_method();

}  // namespace touchstone::baselines

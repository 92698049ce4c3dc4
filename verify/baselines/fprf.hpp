#pragma once

/// \file
/// FPRF: the floating-point root finder ([provot1997]; in the interval form of E. Vouga's
/// public code [vouga2010], as compared by [wang2021]). docs/methods.md, section 5.
///
/// The primitives' planes, or lines, are within η of each other where D(t) = f(t)² − η²‖n(t)‖² ≤ 0,
/// f being the triple product n·q that vanishes in coplanarity. Further polynomials are not
/// negative while the vertex is inside the face, or the nearest points are inside the edges. The
/// times at which each has its sign are found as intervals (sign_intervals.hpp); their
/// intersection, if not empty, is a collision at its earliest time. All computations are in double
/// precision, without error bounds. η is the distance of fast::MethodOptions::separation; it is
/// Euclidean, and 0 in the paper's table 1.
///
/// **Promise.** None.
///
/// **Known defects.**
///   - With η = 0, D is a square, and all its zeros double. They are computed as clusters, and a
///     collision is found only if the value in the middle of one rounds to 0 or less: false
///     negatives by chance. (Of random triangles with a collision in the middle at t=1/2, one in
///     six is missed if they translate, three in five if their vertices move independently; of
///     edges two in five.)
///   - The plane through face vertices that move differently turns by a quadratic, but the inside
///     tests treat it as linear: false negatives for deforming faces, for any η. (Of triangles with
///     independent random vertices and a collision in the middle at t=1/2, η = 1e-3, two in seven
///     are missed; none if the triangle translates.)
///   - Edges that are parallel at contact, |e × g| < 1e-8 in units of the coordinates squared, are
///     left to a handler that does not exist: false negatives. (This includes all edges of a
///     ten-thousandth.)
///   - η acts between the interiors: a vertex that passes a face's edge, or edges whose ends pass,
///     within η are false negatives.
///   - D vanishes together with n: false positives, and times too early. (The printed query H: t =
///     0.5, and contact is at 0.9.)
///   - The time is a rounded zero, which at times is later than the contact (on the public data one
///     answer in ten); callers use it as a safe time, and it is reported as toi_lower.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solves one query. Uses separation.distance (η, Euclidean) and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, or no.
[[nodiscard]] fast::Answer fprf(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The method `fprf`, which promises nothing.
[[nodiscard]] std::unique_ptr<fast::Method> fprf_method();

}  // namespace touchstone::baselines

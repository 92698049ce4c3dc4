#pragma once

/// \file
/// FPRF: the floating-point root finder ([provot1997]; in the interval form of E. Vouga's
/// public code [vouga2010], as compared by [wang2021]). docs/methods.md, section 5.
///
/// The primitives' planes, or lines, are within η of each other where D(t) = f(t)² − η²‖n(t)‖² ≤ 0,
/// f being the triple product n·q that vanishes in coplanarity. Further polynomials are not
/// negative where the vertex is inside the face, or the nearest points inside the edges. The times
/// where each has its sign are found as intervals (sign_intervals.hpp); where all overlap is a
/// collision, at the earliest such time. All in double precision, without error bounds. η is
/// fast::MethodOptions::min_separation; it is Euclidean, and 0 for what the paper's table 1 shows.
///
/// **fast::Promise.** None.
///
/// **Known defects.**
///   - With η = 0, D is a square, and all its zeros double. They come out as clusters, and a hit
///     needs the middle of one to have a value that rounds to 0 or less: false negatives by chance.
///     (Random triangles that are hit in the middle at t=1/2: one in six is missed where they
///     translate, three in five where their vertices move independently; of edges two in five.)
///   - The plane through face vertices that move differently turns by a quadratic, but the inside
///     tests take it for linear: false negatives where the face deforms, whatever η. (Triangles of
///     independent random vertices, hit in the middle at t=1/2, η = 1e-3: two in seven are missed;
///     none where the triangle translates.)
///   - Edges that are parallel at contact, |e × g| < 1e-8 in units of the coordinates squared, are
///     left to a handler that does not exist: false negatives. (So are all edges of a
///     ten-thousandth.)
///   - η acts between the interiors: a vertex that passes a face's edge, or edges whose ends pass,
///     within η are false negatives.
///   - Where n vanishes, D does: false positives, and times too early. (The printed query H: t =
///     0.5, and contact is at 0.9.)
///   - The time is a rounded zero, which at times is later than the contact (on the public data one
///     answer in ten); callers take it for how far they may go, and toi_lower says it.

#include <memory>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::baselines {

/// Decides one query. Uses min_separation (η, Euclidean) and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, or no.
[[nodiscard]] fast::Answer fprf(Kind kind, const Query& query, const fast::MethodOptions& options);

/// As a method called `fprf`, which promises nothing.
[[nodiscard]] std::unique_ptr<fast::Method> fprf_method();

}  // namespace touchstone::baselines

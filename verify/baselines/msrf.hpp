#pragma once

/// \file
/// MSRF: the minimum-separation root finder ([harmon2011], [lu2019]; as compared by
/// [wang2021]). docs/methods.md, section 11.
///
/// At a first contact within h the distance of two features is h. For each pair of features that is
/// a polynomial equation: degree 6 for a vertex and the face or two edges (f(t)² = h²‖n(t)‖²), 4
/// for a vertex and the line of an edge, 2 for two vertices. The real zeros in [0,1] are
/// candidates; at each, the points are moved there and the distance of the primitives is computed
/// (closest_features.hpp). The earliest with a square s of |s| ≤ h² + 0.1 h is the impact. For two
/// edges only the lines' equation is solved. All computations are in double precision, without
/// error bounds.
///
/// h is the distance of fast::MethodOptions::separation, or 1e-8 if that is 0, as in the
/// benchmark's harness. It is Euclidean.
///
/// **Promise.** None.
///
/// **Known defects.**
///   - s is a squared length and 0.1 h a length: the reach is √(h² + 0.1 h), 3.2e-5 for h = 1e-8,
///     in any unit. A pass within it is a false positive.
///   - For h → 0 the zeros of degree 6 are nearly double, and are computed as complex pairs, which
///     are not candidates: false negatives. (Of triangles of random vertices with a collision in
///     the middle at t=1/2, nearly all are missed at h = 1e-100, about one in twenty at 1e-8,
///     hardly any at 1e-2. The printed query H is missed for h ≤ 1e-16.)
///   - Pairs within h from the start have no zero, and are missed; so is motion in a plane at that
///     distance.
///   - The candidates of two edges are only those of their lines: contacts of ends, and parallel or
///     collinear edges, are false negatives.
///   - One of the quick tests for a polynomial of degree 6 without a zero omits its coefficients
///     from t⁴ on: false negatives. Another takes coefficients that are all 0 or positive for a
///     polynomial without a zero in [0,1], though t = 0 may be one: contact at the start is missed.
///   - The time is a rounded zero, which at times is later than the contact; callers use it as a
///     safe time, and it is reported as toi_lower.

#include <memory>
#include <span>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// The value of h if no separation is requested.
inline constexpr double msrf_default_separation = 1e-8;

/// The quick tests before the polynomial of degree 6 is solved: true if it has no zero in [0,1] by
/// its seven coefficients, the constant first. Sometimes wrong: see the defects above.
[[nodiscard]] bool msrf_rules_out_zeros(std::span<const double, 7> coefficients);

/// Solves one query. Uses separation.distance (h, Euclidean) and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, or no.
[[nodiscard]] fast::Answer msrf(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The method `msrf`, which promises nothing.
[[nodiscard]] std::unique_ptr<fast::Method> msrf_method();

}  // namespace touchstone::baselines

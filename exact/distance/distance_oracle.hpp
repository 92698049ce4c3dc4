#pragma once

/// \file
/// The oracle for a minimum separation: whether and when a query comes within a distance, exactly.
///
/// **Theorem.** A query collides at distance d iff P(t) = conv{w_i(t)} has a point x with ‖x‖ ≤ d for
/// some t ∈ [0,1], where w_i are the corners of F. Proof: F(t,·,·) has the image P(t).
///
/// The first such time is found by the walk along separators (exact/distance/separating_axes.hpp): it is 0 or a root
/// of one of their polynomials, of degree at most 8. Then it is checked to be a time of contact by what
/// holds at one (exact/contact/contact_conditions.hpp), the one description that says nothing of separators. Before
/// it every time has a separator. No case is left out: zero-length edges, faces without area, polygons
/// that are points fall under the same rules.
///
/// Everything is integer arithmetic on coordinates and d scaled once by one power of two; there is no
/// rounding and no filter.

#include <optional>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/query.hpp"

namespace touchstone::exact {

/// What is true of a query and a distance.
struct DistanceVerdict {
  /// The first time in [0,1] at which the primitives are within the distance; empty iff they never are.
  std::optional<AlgebraicNumber> toi;

  [[nodiscard]] bool collides() const { return toi.has_value(); }
};

/// Decides a query at a distance exactly; at distance 0 it is the verdict of decide(kind, query).
/// Thread-safe, and independent of the floating-point environment. docs/theory.md, section 3.
/// \throws std::invalid_argument if a coordinate is NaN or infinite, or the separation is not valid.
[[nodiscard]] DistanceVerdict decide(Kind kind, const Query& query, const Separation& separation);

/// The same for a motion that is scaled uniformly, by the walk for distance 0 too.
[[nodiscard]] DistanceVerdict decide_by_walk(const Motion& motion);

}  // namespace touchstone::exact

#pragma once

/// \file
/// The oracle: whether and when a query collides, decided exactly.
///
/// **Theorem.** A query collides iff 0 ∈ conv{w_i(t)} for some t ∈ [0,1], where w_i are the corners
/// of F.
///
/// For fixed t this is decided by signs alone. Let N be the polygon's normal.
///   - det(w_0, w_1, w_last) ≠ 0: the origin is not in the polygon's plane. No.
///   - N ≠ 0, say N_k ≠ 0: the origin is in the polygon iff it is on the inner side of every edge,
///     that is iff (w_i × w_{i+1})_k · sign N_k ≥ 0 for every edge i, i+1 in cyclic order.
///   - N = 0: the polygon is a segment or a point, covered by its edges (a closed path on a line
///     passes every point between its ends). The origin is in it iff for some edge i, j
///     w_i × w_j = 0 and w_i · w_j ≤ 0.
///
/// As t moves these are polynomials, det of degree 3, the others of degree 2. The set of times of
/// contact is closed, so if it is not empty it has a least element. Candidates for it are
///   - det ≢ 0: the roots of det in [0,1].
///   - det ≡ 0, some N_k ≢ 0 (a polygon whose plane always holds the origin): 0 and the roots in
///     [0,1] of N_k and of the (w_i × w_{i+1})_k. Between neighbouring ones N_k ≠ 0 and no sign of
///     the rule changes, so the answer is the same throughout, and a closed set that begins there
///     begins at a candidate.
///   - det ≡ 0, N ≡ 0 (always a segment): 0 and for every edge i, j the roots in [0,1] of w_i · w_j
///     and of one component of w_i × w_j, those that are not identically zero. Between neighbouring
///     ones every edge keeps its answer.
/// The signs are evaluated exactly at each candidate in ascending order; the first that holds is
/// the time of impact. The contact's (u,v) follow from the same minors by Cramer's rule, and
/// F(toi,u,v) = 0 is then checked on F itself, evaluated from the eight points: the one check that
/// does not rest on the theorem. No case is left out: parallel edges, needle triangles and points
/// on points fall under these rules.
///
/// Everything is integer arithmetic on coordinates scaled once; there is no rounding and no filter.

#include <optional>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/algebra/number.hpp"
#include "exact/algebra/polynomial.hpp"
#include "exact/query.hpp"

namespace touchstone::exact {

/// Where on the primitives they touch: u = u_numerator(toi) / denominator(toi), likewise v, each a
/// polynomial in t of degree at most 2. One point of the overlap where the contact is not a single
/// point.
struct Contact {
  Polynomial u_numerator;
  Polynomial v_numerator;
  /// Positive at the toi.
  Polynomial denominator;
};

/// The earliest contact of a query that collides.
struct Impact {
  /// The exact time of impact, in [0,1]: an algebraic number of degree at most 3.
  AlgebraicNumber toi;
  Contact contact;
};

/// What is true of a query.
struct Verdict {
  /// The earliest contact; empty iff the query does not collide.
  std::optional<Impact> impact;

  [[nodiscard]] bool collides() const { return impact.has_value(); }
};

/// Decides a query exactly. Thread-safe, and independent of the floating-point environment (rounding
/// mode, flushed subnormals). docs/theory.md, section 2.
/// \throws std::invalid_argument if a coordinate is NaN or infinite.
[[nodiscard]] Verdict decide(Kind kind, const Query& query);

/// The contact's parameters (u,v), as the query's F defines them.
struct ContactParameters {
  RationalInterval u;
  RationalInterval v;
};

/// (u,v) of the earliest contact, each within `width` > 0; exact (both ends equal) where the toi is
/// known to be rational.
[[nodiscard]] ContactParameters contact_parameters(const Impact& impact, const Rational& width);

}  // namespace touchstone::exact

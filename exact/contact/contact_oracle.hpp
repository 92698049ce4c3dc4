#pragma once

/// \file
/// The oracle at distance 0: an exact decision if, when and where a query collides.
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
/// As functions of t these values are polynomials, det of degree 3, the others of degree 2, for
/// motion on straight lines; of degrees 3k and 2k for motion on curves of degree k. The set of
/// times of contact is closed, so if it is not empty it has a least element. The candidates are
///   - det ≢ 0: the roots of det in [0,1].
///   - det ≡ 0, some N_k ≢ 0 (a polygon whose plane always contains the origin): 0 and the roots in
///     [0,1] of N_k and of the (w_i × w_{i+1})_k. Between neighbouring ones N_k ≠ 0 and no sign of
///     the rule changes, so the answer is constant there; a closed set that begins there begins at
///     a candidate.
///   - det ≡ 0, N ≡ 0 (always a segment): 0 and for every edge i, j the roots in [0,1] of w_i · w_j
///     and of one component of w_i × w_j, if these do not vanish identically. Between neighbouring
///     ones the answer for each edge is constant.
/// The signs are evaluated exactly at each candidate in ascending order; the first that holds is
/// the time of impact. The contact's (u,v) follow from the same minors by Cramer's rule, and
/// F(toi,u,v) = 0 is then checked on F itself, evaluated from the eight points. This check does not
/// depend on the theorem. The rules cover every case: also parallel edges, needle triangles and
/// coinciding points.
///
/// docs/theory.md, section 2.

#include "exact/contact/corner_motion.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact {

/// The verdict at distance 0, with the place of contact. Each axis of the motion may have its own
/// unit.
/// \throws std::logic_error if F is not zero at the contact, that is if the oracle is wrong.
template <class Order>
[[nodiscard]] Decision decide_contact(const MotionOf<Order>& motion);

}  // namespace touchstone::exact

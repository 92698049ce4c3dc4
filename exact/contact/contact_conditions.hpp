#pragma once

/// \file
/// The place of a contact at a given time, and the signs that prove it.
///
/// P = conv{w_i} is the polygon of corners at that time. It contains the origin iff one of these
/// parts does:
///   - the triangle i, j, k, with normal N' = (w_j − w_i) × (w_k − w_i): N'_axis ≠ 0,
///     det(w_i, w_j, w_k) = 0, and (w_i × w_j)_axis, (w_j × w_k)_axis, (w_k × w_i)_axis each zero
///     or of the sign of N'_axis;
///   - or the segment i, j: w_i × w_j = 0 and w_i · w_j ≤ 0.
/// In l2, P is within the distance d of the origin iff one of these parts is, namely the one that
/// contains the closest point:
///   - the vertex i: |w_i|² ≤ d²;
///   - the edge i, j, with e = w_j − w_i ≠ 0: w_i·e ≤ 0 ≤ w_j·e, so that the foot of the
///     perpendicular is on it, and |w_i × w_j|² ≤ d²|e|²;
///   - the face, N ≠ 0: N·(w_i × w_j) ≥ 0 for every side i, j in cyclic order, likewise, and
///     (N·w_0)² ≤ d²|N|².
/// In linf, P is within d iff none of the axes a of exact/distance/separating_axes.hpp separates:
/// for each axis some corner has a·w_i ≤ d‖a‖₁ and some corner a·w_j ≥ −d‖a‖₁. With σ the signs of
/// a's components the first is a·w_i ≤ d(σ·a); if it holds for any other σ, it holds for this one.

#include <optional>
#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "touchstone/algebraic_number.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::exact {

/// A place with the polynomials whose signs at the time prove it, divided into zero and nonzero
/// ones. Polynomials that vanish identically are left out.
struct ContactConditions {
  ContactPlace place;
  std::vector<Polynomial> zero;
  std::vector<Polynomial> nonzero;
};

/// The triangle or segment that contains the origin at a time; empty if the polygon does not.
template <class Order>
[[nodiscard]] std::optional<ContactConditions> find_contact(const MotionOf<Order>& motion,
                                                            AlgebraicNumber& time);

/// A place of the motion's norm that is within the motion's distance at a time; empty if the
/// polygon is farther away. Distance 0 is allowed. \pre the motion is scaled uniformly.
template <class Order>
[[nodiscard]] std::optional<ContactConditions> find_near_contact(const MotionOf<Order>& motion,
                                                                 AlgebraicNumber& time);

}  // namespace touchstone::exact

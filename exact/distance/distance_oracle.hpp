#pragma once

/// \file
/// The oracle at a distance: an exact decision if and when a query comes within it.
///
/// **Theorem.** A query collides at distance d iff P(t) = conv{w_i(t)} has a point x with ‖x‖ ≤ d
/// for some t ∈ [0,1], where w_i are the corners of F. Proof: F(t,·,·) has the image P(t).
///
/// At every earlier time some axis separates. The search (exact/distance/separating_axes.hpp) goes
/// from 0 to the first time at which no axis separates: a root of one of their polynomials, of
/// degree at most 8 (8k for curves of degree k). That time is then checked by the conditions of a
/// contact (exact/contact/contact_conditions.hpp), which do not depend on separating axes. The
/// rules cover every case: also zero-length edges, faces without area and polygons that are points.
///
/// docs/theory.md, section 3.

#include "exact/contact/corner_motion.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact {

/// The verdict at the motion's distance, which may be 0, without the place of contact.
/// \pre the motion is scaled uniformly.
/// \throws std::logic_error if search and conditions disagree, that is if the oracle is wrong.
template <class Order>
[[nodiscard]] Decision decide_distance(const MotionOf<Order>& motion);

}  // namespace touchstone::exact

#pragma once

/// \file
/// The nearest points of two primitives, and their normal, with bounds of the errors, at a time
/// that is known between two doubles.
///
/// Let τ be the time, K = {F(τ,u,v)} the polygon with the corners w_k, F* its point nearest to the
/// origin, which is unique, and F^ = F(τ,û,v̂) for given parameters in the domain. All numbers are
/// balls (touchstone/filters/ball.hpp) that contain the values at all times of the enclosure, so
/// what they prove holds at τ. docs/theory.md, section 8.9, has the proofs:
///
/// **Touching** (F* = 0). η = |F^| bounds |F^ − F*|.
///
/// **Apart.** With m_k = F^·(w_k − F^), the least of these bounds |F^ − F*|, besides |F^|:
///   - corner, if F^ is one, and m_k > 0 for all others: 0;
///   - side e, if F^ is on it, and G = |F^·e|/|e| ≤ m/(2R) with the least m of m_k for the other
///     corners and R = |p| + |q|: G;
///   - interior: (|F^·p|/|p| + |F^·q|/|q|) / sin(p,q);
///   - parallel, if p × q = 0 exactly (they are along an axis, equal or opposite): |F^·e|/|e| with
///     the longer e of p and q;
///   - otherwise √(max_k −m_k).
///
/// **Points.** x* of a vertex has no error but that of the time, and y* = x* − F* differs from ŷ by
/// η more. On edges, the error of a point is at most η / sin(p,q); on a corner or a side, and for
/// parallel edges, it has bounds of its own; and no error is greater than the edge.

#include <Eigen/Core>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// A time in [0,1] between doubles: lower ≤ τ ≤ upper.
struct TimeEnclosure {
  double lower = 0.0;
  double upper = 0.0;
};

/// The meaning of all but `at` is that of ActiveContact (touchstone/contacts.hpp).
struct ContactEnclosure {
  exact_stage::Parameters at;  ///< those of the points, exactly in the domain
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double point_error = 0.0;
  double normal_error = 0.0;
  bool has_side = false;
};

/// \param approximate parameters of the nearest points
/// \param is_touching true if the primitives have a common point at τ
/// \pre all coordinates are finite; 0 ≤ time.lower ≤ time.upper ≤ 1; strict floating point.
[[nodiscard]] ContactEnclosure enclose_contact(ContactKind kind, const Query& query,
                                               const TimeEnclosure& time,
                                               const exact_stage::Parameters& approximate,
                                               bool is_touching);

}  // namespace touchstone::fast

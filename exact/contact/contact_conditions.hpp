#pragma once

/// \file
/// Where the primitives touch at a time of contact, and the signs that prove it.
///
/// P = conv{w_i} is the polygon of corners at that time. It holds the origin iff one of these does:
///   - the triangle i, j, k, with normal N' = (w_j − w_i) × (w_k − w_i): N'_axis ≠ 0,
///     det(w_i, w_j, w_k) = 0, and (w_i × w_j)_axis, (w_j × w_k)_axis, (w_k × w_i)_axis each zero or
///     of the sign of N'_axis;
///   - or the segment i, j: w_i × w_j = 0 and w_i · w_j ≤ 0.
/// It is within the distance d of the origin, in l2, iff one of these is, which holds the nearest
/// point:
///   - the vertex i: |w_i|² ≤ d²;
///   - the edge i, j, with e = w_j − w_i ≠ 0: w_i·e ≤ 0 ≤ w_j·e, so that the foot of the perpendicular
///     is on it, and |w_i × w_j|² ≤ d²|e|²;
///   - the face, N ≠ 0: N·(w_i × w_j) ≥ 0 for every side i, j in cyclic order, likewise, and
///     (N·w_0)² ≤ d²|N|².
/// In linf, iff none of the axes a of exact/distance/separating_axes.hpp separates: for each some corner is not
/// above, a·w_i ≤ d‖a‖₁, and some not below, a·w_j ≥ −d‖a‖₁. With σ the signs of a's components this
/// is a·w_i ≤ d(σ·a), and where it holds for any other σ it holds for this one.

#include <array>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/algebra/polynomial.hpp"
#include "exact/contact/corner_motion.hpp"

namespace touchstone::exact {

/// The origin is in the triangle of three corners; their normal's component `axis` is not zero.
struct TriangleContact {
  std::array<std::size_t, 3> corners;
  std::size_t axis;

  friend bool operator==(const TriangleContact&, const TriangleContact&) = default;
};

/// The origin is on the segment between two corners.
struct SegmentContact {
  std::array<std::size_t, 2> corners;

  friend bool operator==(const SegmentContact&, const SegmentContact&) = default;
};

/// In l2: this corner is within the distance.
struct VertexContact {
  std::size_t corner;

  friend bool operator==(const VertexContact&, const VertexContact&) = default;
};

/// In l2: a point between two corners is within the distance.
struct EdgeContact {
  std::array<std::size_t, 2> corners;

  friend bool operator==(const EdgeContact&, const EdgeContact&) = default;
};

/// In l2: a point of the face is within the distance.
struct FaceContact {
  friend bool operator==(const FaceContact&, const FaceContact&) = default;
};

/// In linf: no axis separates.
struct AxesContact {
  friend bool operator==(const AxesContact&, const AxesContact&) = default;
};

using ContactPlace = std::variant<TriangleContact, SegmentContact, VertexContact, EdgeContact,
                                  FaceContact, AxesContact>;

/// A place, and polynomials whose signs at the time prove it: those that are zero there, and the
/// others. What is zero at all times is left out.
struct ContactConditions {
  ContactPlace place;
  std::vector<Polynomial> zero;
  std::vector<Polynomial> nonzero;
};

/// The triangle or segment that holds the origin at a time; empty if the polygon does not.
[[nodiscard]] std::optional<ContactConditions> find_contact(const Motion& motion,
                                                            AlgebraicNumber& time);

/// The place of the motion's norm that is within its distance at a time; empty if the polygon is
/// farther. Right for distance 0 too. \pre the motion is scaled uniformly.
[[nodiscard]] std::optional<ContactConditions> find_near_contact(const Motion& motion,
                                                                 AlgebraicNumber& time);

}  // namespace touchstone::exact

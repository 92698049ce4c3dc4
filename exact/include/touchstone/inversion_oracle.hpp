#pragma once

/// \file
/// The oracle of inversions: whether and when an element of a mesh loses its volume, decided
/// exactly.
///
/// **Theorem.** Let V be the signed volume (touchstone/element.hpp), a continuous function of time.
/// If V(0) ≤ 0, the first time with V ≤ 0 is 0. Otherwise it is the least root of V in [0,1], and
/// there is none if V has no root there.
/// Proof. Before its least root a continuous function has the sign that it has at 0. ∎
///
/// On straight lines V is a polynomial of degree 3 (2 for triangles); on curves of degree k, of
/// degree 3k, divided by a polynomial that is positive on [0,1]. Coordinates are multiplied by
/// powers of two that make them integers, one power for each axis, which keeps signs of V. The root
/// is isolated as those of collisions are (touchstone/algebraic_number.hpp): roots of every
/// multiplicity count. docs/theory.md, section 10. All functions are thread-safe.

#include <optional>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/element.hpp"
#include "touchstone/query.hpp"

namespace touchstone::exact {

/// The truth about an element.
struct InversionDecision {
  /// The sign of the volume at t=0: 1, 0 (flat) or −1 (inverted).
  int start = 0;
  /// The first time in [0,1] at which the volume is 0 or negative: 0 iff `start` is not positive,
  /// otherwise a root of the volume. Empty iff the element does not invert.
  std::optional<AlgebraicNumber> time = std::nullopt;

  [[nodiscard]] bool inverts() const { return time.has_value(); }
};

/// Decides a tetrahedron exactly, independent of the floating-point environment.
/// \throws std::domain_error if a coordinate is NaN or infinite.
[[nodiscard]] InversionDecision decide_inversion(const Query& tetrahedron);

/// Decides a tetrahedron whose points move on curves.
/// \throws std::domain_error if a number is NaN or infinite, or a weight not positive;
/// std::invalid_argument if a trajectory is not valid.
[[nodiscard]] InversionDecision decide_inversion(const CurvedQuery& tetrahedron);

/// Decide a triangle in the plane. \throws as above.
[[nodiscard]] InversionDecision decide_inversion(const PlaneTriangle& triangle);
[[nodiscard]] InversionDecision decide_inversion(const CurvedTriangle& triangle);

}  // namespace touchstone::exact

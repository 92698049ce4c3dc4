#pragma once

/// \file
/// Whether an argument shows that two elements at rest have nothing in common beyond what they
/// share, or that they have: in integers of any size.
///
/// An *element* is the convex hull of its vertices: of three, two or one. Let A and B be the
/// vertices of two elements, by their numbers, and C those of both. The elements *intersect* if
/// A = B, or if they have a point in common that is not in the hull of C. The hull of no vertices
/// is empty; if A ≠ B, C has at most two vertices.
///
/// **Theorem 1.** Let d be a vector.
///   - If C is empty and d·a > d·b for all a of A and b of B, the elements have no point in common.
///   - Let h = d·c for a vertex c of C, d·a ≥ h for all a of A, d·b ≤ h for all b of B (so d·c = h
///     for all of C), and let the vertices a with d·a = h all be in the hull of C, or the vertices
///     b with d·b = h. Then every point that the elements have in common is in the hull of C.
///
/// Proof. The first is clear. A common point x is Σ α_a a with α_a ≥ 0 and Σ α_a = 1, so d·x ≥ h,
/// and likewise d·x ≤ h. So d·x = h, and α_a > 0 only if d·a = h: x is in the hull of such a, and
/// of such b.
///
/// **Theorem 2.** Let the vertices of A be on a line, those of B on a line, and C not empty. If
/// these lines are not parallel, the elements have one point in common, a vertex of C. If all
/// vertices are on one line, let them be ordered along it. If max(min A, min B) ≥ min C and min(max
/// A, max B) ≤ max C, every common point is in the hull of C: they are the segment from the one to
/// the other.
///
/// **Theorem 3.** Let α_a ≥ 0 with the sum α > 0, β_b ≥ 0 with the sum β > 0, and
/// β Σ α_a a = α Σ β_b b. Then this vector over αβ is a point of both elements.

#include <gmpxx.h>

#include <array>
#include <span>
#include <vector>

#include "exact/checker/places.hpp"

namespace touchstone::checker {

/// x y z.
using Vector = std::array<mpz_class, 3>;

class RestingPair {
 public:
  /// The places of the vertices at the start, multiplied by the least power of two that makes them
  /// integers.
  RestingPair(const std::vector<Motion>& vertices, const Primitive& a, const Primitive& b);

  /// True if both have the same vertices: they intersect.
  [[nodiscard]] bool are_duplicates() const { return are_duplicates_; }

  /// True if theorem 1 shows with this direction that they do not intersect.
  [[nodiscard]] bool is_separated_by(const Vector& d) const;
  /// True if it shows it with the normal of the first element's plane, or the opposite.
  [[nodiscard]] bool is_separated_by_first_plane() const;
  /// True if theorem 2 shows it.
  [[nodiscard]] bool are_separated_on_lines() const;

  /// True if theorem 3 gives a common point, and it is not in the hull of C.
  /// \param of_a, of_b weights: one for each vertex, in order, or for the first vertices
  [[nodiscard]] bool is_common_point(std::span<const mpz_class> of_a,
                                     std::span<const mpz_class> of_b) const;

 private:
  using Corners = std::array<Vector, 3>;

  /// True if x / scale is in the hull of C. \pre the scale is positive
  [[nodiscard]] bool is_in_common_hull(const Vector& x, const mpz_class& scale = 1) const;

  Corners a_;
  Corners b_;
  /// The places of C, in the order of A; of A = B all.
  std::vector<Vector> common_;
  bool are_duplicates_ = true;
};

}  // namespace touchstone::checker

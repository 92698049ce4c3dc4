#pragma once

/// \file
/// The first time at which a moving polygon is within a distance of the origin: any motion with
/// integer coordinates of any size, any distance > 0, both norms.
///
/// P(t) is the polygon with the corners w_k(t) (contact_conditions.hpp), B the closed ball of
/// radius d of a norm: for linf the cube [−d,d]³. A *separator* is a direction a(t) with forms in
/// t; it *holds* at t iff all its forms are positive there, and then a·w_k(t) > max of a·b over b ∈
/// B for all k, so that P(t) does not meet B.
///
/// **Theorem 1** (l2). P(t) does not meet B iff one of these holds at t, where i, k are corners, ij
/// is a side of the polygon, e = w_j − w_i, C = |w_i × w_j|² and N the polygon's normal:
///   - vertex, a = w_i:  |w_i|² − d², and for every k ≠ i  w_i·w_k and (w_i·w_k)² − d²|w_i|²;
///   - side, a = |e|² w_i − (w_i·e) e:  C − d²|e|², and for every other k  a·w_k and
///     (a·w_k)² − d²|e|²C;
///   - face, a = ±N:  (N·w_0)² − d²|N|².
/// Proof. The maximum of a·b is d|a|. For the vertex the forms say just a·w_k > d|a|; the first
/// says it for k = i. For the side a·w_i = a·w_j = C and |a|² = |e|²C, so a·w_i > d|a| iff C >
/// d²|e|² (which needs C > 0). All corners have the same N·w_k. So a separator that holds
/// separates. Now let P(t) not meet B and x be its point nearest to the origin, |x| > d. P(t) lies
/// in the half-space x·w ≥ |x|² > d|x|, so the direction x separates. x is in the relative interior
/// of a vertex, a side or the face of P(t); it is orthogonal to that feature, hence the feature's
/// direction above up to a positive factor: |e|²x, or N times a nonzero number. A polygon without
/// area is covered by its sides, and a side without length by its ends; so features with e = 0 or N
/// = 0, which never hold, are not needed. ∎
///
/// **Theorem 2** (linf). P(t) does not meet B iff a·w_k − d(σ·a) > 0 for all corners k and all sign
/// vectors σ, for a one of ±e_c, ±N, ±(e_c × e), e_c a coordinate axis and e a side. Proof. The
/// maximum of a·b is d(|a_x| + |a_y| + |a_z|), the greatest of the d(σ·a). P(t) and B meet iff the
/// origin is in the polytope Q = B ⊕ −P(t). It is full-dimensional, and so the
/// intersection of the half-spaces of its facets; a facet of a sum is the sum of faces of both, and
/// its normal is that of a facet of B, that of P(t), or orthogonal to an edge of each. ∎
///
/// **Theorem 3** (the walk). Begin at t = 0. If no separator holds at t, t is the answer. Otherwise
/// take one that holds and go to the first root of its forms later than t; if there is none, the
/// polygon never meets B. The walk ends at the first time at which P(t) meets B. Proof. From t up
/// to that root (exclusive) the separator's forms stay positive, so no time before the new t is the
/// answer; if no separator holds there, it is the answer by theorem 1 or 2. Every step goes to a
/// later one of finitely many roots. ∎
///
/// Every separator that holds is correct; the one that holds longest is taken. Other separating
/// directions may be tried before those of the theorems: the coordinate axes first, for l2 too,
/// whose forms are the lowest; and with few forms of low degree
///   - vertex: |w_i|² − d², and w_i·w_k − |w_i|² for every other k;
///   - side: C − d²|e|², and a·w_k − C for another k,
/// which imply those above. They fail in place of theorem 1 only if the polygon degenerates. The
/// separators of the theorems are made when no axis holds.
///
/// *Denominators.* The points of curves are fractions (fraction.hpp), and only signs count.
/// Products of corners have each denominator as often as corners do; but the forms need fewer of
/// them, by
/// **Theorem 4.** Let a, b, c, d be the points of the query.
///   - Neighbouring corners share a point c up to its sign, and w_i × w_j = (a − c) × (b − c) =
///     a × b + b × c + c × a, with each denominator once.
///   - N = (w_1 − w_0) × (w_last − w_0) is e × f for any side e and the next one f. For a triangle
///     it is such a sum, for a parallelogram the product of two differences.
///   - N·w_0 is, up to its sign, (a × b + b × c + c × a)·d − a·(b × c), with each denominator once.
///   - A side's a·w_k is (w_i × e)·(w_k × e), and (w_k − w_i) × e = −N for the other corners k. So
///     a·w_k = C − N·(w_i × w_j), and for linf (e_c × e)·w_k = N_c − (w_i × w_j)_c.
/// Proof. The first two lines are calculation: opposite sides of a parallelogram are opposite
/// vectors, and the sum of a triangle's is 0. N·w_0 is the determinant of the points' differences,
/// six times the volume of their tetrahedron, for both kinds. (w_i × e)·(w_k × e) = (w_i·w_k)|e|² −
/// (w_i·e)(e·w_k) = a·w_k; and with f the side after e, w_k − w_i is e + f, or a vector that
/// differs from that by a multiple of e. ∎ Four denominators of degree n thus leave the highest
/// form the degree 14n, where corners times all denominators give 32n and most of the forms squared
/// factors.

#include <array>
#include <cstdint>
#include <optional>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/contact_conditions.hpp"
#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/fraction.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// numerator / 2^exponent, in the units of a motion's coordinates. Positive.
struct ScaledDistance {
  BigInteger numerator;
  long exponent = 0;  ///< not negative
};

/// A distance > 0 in units of 2^unit.
[[nodiscard]] ScaledDistance scaled_distance(double distance, int unit);

/// The points of a query, in the order of its kind.
struct MovingPoints {
  ContactKind kind = ContactKind::vertex_face;
  std::array<std::array<Fraction, 3>, moving_points> points;
};

/// The first time, not later than the double in [0,1] of bits `latest`, at which the polygon is
/// within the distance of the origin: doubles around it at most `step` spacings apart, one if
/// `upper` is subnormal (lower < time ≤ upper, or both 0 if the time is 0); empty if there is no
/// such time.
/// \pre all axes have the same unit; 1 ≤ step.
[[nodiscard]] std::optional<BitInterval> first_approach(const MovingPoints& points,
                                                        const ScaledDistance& distance, Norm norm,
                                                        std::uint64_t latest, std::uint64_t step);
/// The same for a motion on straight lines.
[[nodiscard]] std::optional<BitInterval> first_approach(const Motion<BigInteger>& motion,
                                                        const ScaledDistance& distance, Norm norm,
                                                        std::uint64_t latest, std::uint64_t step);

}  // namespace touchstone::fast::exact_stage

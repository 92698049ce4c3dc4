#pragma once

/// \file
/// The proof that there is no contact up to a time: the time is divided into subintervals, each
/// with one direction that separates all corners from the ball of the distance throughout the
/// subinterval.
///
/// While the polygon conv{w_i(t)} is farther from the origin than the distance, the direction of
/// some feature separates (exact/distance/separating_axes.hpp), on an open set of times. Finitely
/// many of these sets cover the interval. The number of subintervals is least if, at the first time
/// not yet covered, the feature that holds longest is taken.

#include <vector>

#include "exact/contact/corner_motion.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/number.hpp"

namespace touchstone::exact {

/// The fewest subintervals that cover [0,until], each beginning at the end of the one before. A
/// subinterval for which a checker would have to bisect more often than bisection_limit is divided
/// further, into two or three if the polynomial has one minimum that is so close to zero. Break
/// points are rationals of few bits.
/// \param until In [0,1]; at 0 the only subinterval is a point.
/// \pre the motion is scaled uniformly, and nothing is within its distance in [0,until].
/// \throws std::logic_error if something does.
/// \throws CertificateLimitError if a break point needs more than number_limit bits. Where the
/// corners and the distance are integers below 2^s, the values are polynomials of degree at most 4
/// with coefficients below 2^(4s+10). Roots of two of them are at least 2^(−32s−100) apart (their
/// resultant, or that of coprime factors, is a nonzero integer), two roots of one 2^(−12s−100)
/// [mahler1964]. A break between features needs at most the bits of the first bound; one for a
/// checker needs those of the second and of `until` in addition. So nothing is thrown while s ≤ 300
/// and `until` has at most 2,000 bits, that is while the largest coordinate is below 2^300 times
/// the last bit of any other. Beyond that an exception needs features that change, or nearly
/// vanish, at times as close to each other. At a distance > 0 in l2 the degree is 8 and the
/// coefficients are below 2^(8s+24): the bounds are 2^(−128s−500) and 2^(−56s−400), and s ≤ 70 is
/// enough. On curves all degrees, and with them the exponents, are greater.
template <class Order>
[[nodiscard]] std::vector<Subinterval> separate(const MotionOf<Order>& motion,
                                                const Rational& until);

/// The same of positive volume: subintervals of the feature `negative_face`, whose condition at
/// distance 0 is −det(a − b, a − c, a − d) = det(b − a, c − a, d − a) > 0 (touchstone/cell.hpp).
/// There are several only where a checker would have to bisect too often.
/// \param motion a tetrahedron as a vertex and a face, in any units
/// \pre the volume is positive in [0,until]. \throws as separate.
template <class Order>
[[nodiscard]] std::vector<Subinterval> keep_volume(const MotionOf<Order>& motion,
                                                   const Rational& until);

/// True if numerator and denominator have at most number_limit bits.
[[nodiscard]] bool is_within_limit(const Rational& number);

}  // namespace touchstone::exact

#pragma once

/// \file
/// Why a query does not collide: the times from 0 on in pieces, each with one direction that keeps
/// all corners on one side of the origin, and farther from it than asked for.
///
/// While the polygon conv{w_i(t)} is farther from the origin than the distance that counts as contact,
/// the direction of some feature separates (exact/distance/separating_axes.hpp), on an open set of times. Finitely
/// many of these cover the times asked for. Covering from 0 on, always with the feature that holds at
/// the first time not yet covered and reaches farthest, takes the fewest.

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "exact/algebra/number.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/distance/separating_axes.hpp"

namespace touchstone::exact {

/// A certificate would not fit the limits of the format.
class CertificateLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The feature separates on all of [from, to].
struct Piece {
  Rational from;
  Rational to;
  Feature feature;

  friend bool operator==(const Piece&, const Piece&) = default;
};

/// Pieces that cover [0,until], each from where the one before ends, the fewest that can. Where a
/// checker's bisection (bisection_limit) would not reach, a piece is broken further, in two or three
/// where the polynomial has one minimum that near to zero. Break points are rationals of few bits.
/// \param until In [0,1]; at 0 the one piece is a point.
/// \pre the motion is scaled uniformly, and nothing is within its distance in [0,until].
/// \throws std::logic_error if something does.
/// \throws CertificateLimitError if a break point needs more than number_limit bits. Where the corners
/// and the distance are integers below 2^s, the values are polynomials of degree at most 4 with
/// coefficients below 2^(4s+10). Roots of two of them are at least 2^(−32s−100) apart (their
/// resultant, or that of coprime factors, is a nonzero integer), two roots of one 2^(−12s−100)
/// [mahler1964]: a break between features takes at most the bits of the first bound, one for a checker
/// those of the second more, and of `until`. So nothing is thrown while s ≤ 300 and `until` has at most
/// 2,000 bits, that is while the largest coordinate is below 2^300 times the last bit of any other; and
/// beyond that only if features change, or come near to zero, at such a distance of each other. At a
/// distance > 0 in l2 the degree is 8 and the coefficients are below 2^(8s+24): the bounds are
/// 2^(−128s−500) and 2^(−56s−400), and s ≤ 70 is enough.
[[nodiscard]] std::vector<Piece> separate(const Motion& motion, const Rational& until);

/// Numerator and denominator of a number in a certificate have at most so many bits.
inline constexpr std::size_t number_limit = 16384;

/// Has the number at most number_limit bits above and below?
[[nodiscard]] bool is_within_limit(const Rational& number);

}  // namespace touchstone::exact

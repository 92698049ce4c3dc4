#pragma once

/// \file
/// Proofs that a polynomial is positive on an interval, as a checker of certificates makes them.
///
/// The Bernstein coefficients of p on [a,b] enclose its values: if all are positive, so is p. If
/// one is not, [a,b] is halved. For a p that is positive on [a,b] the proof succeeds at some depth,
/// about the logarithm of the distance of its nearest complex root. A checker limits the depth, so
/// the writer of a certificate must know the depth of a proof and its place.

#include <cstdint>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::exact {

/// The maximum number of times that a checker of certificates halves an interval.
inline constexpr unsigned long bisection_limit = 128;

/// Row n of Pascal's triangle.
[[nodiscard]] std::vector<Integer> binomials(std::size_t n);

/// The Bernstein coefficients of p on an interval, all multiplied by one positive number.
[[nodiscard]] std::vector<Integer> bernstein_coefficients(const Polynomial& p,
                                                          const RationalInterval& interval);

/// The Bernstein coefficients on [0,1] of the form Σ c_k (1−t)^(n−k) t^k
/// (exact/contact/corner_motion.hpp), all multiplied by one positive number.
[[nodiscard]] std::vector<Integer> bernstein_coefficients(std::vector<Integer> form);

/// The sign (−1, 1) that all of the numbers have; 0 if one is zero or they differ in sign.
[[nodiscard]] int common_sign(const std::vector<Integer>& numbers);

/// Outcome of a proof by bisection.
struct BisectionProof {
  enum class Outcome : std::uint8_t {
    positive,  ///< proved
    refuted,   ///< a point was met where the polynomial is not positive
    too_deep   ///< neither, down to the limit
  };

  Outcome outcome = Outcome::positive;
  /// The deepest part of the proof if the outcome is `positive`: part number `index` of 2^depth
  /// equal ones. The first if there are several.
  unsigned long depth = 0;
  Integer index = 0;
};

/// Tries to prove that the polynomial with these Bernstein coefficients is positive on their closed
/// interval, halving it up to `limit` times.
[[nodiscard]] BisectionProof prove_positive(const std::vector<Integer>& bernstein,
                                            unsigned long limit = bisection_limit);

}  // namespace touchstone::exact

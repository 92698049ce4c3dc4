#pragma once

/// \file
/// Proofs that a polynomial is positive on an interval, as a checker of certificates makes them.
///
/// The Bernstein coefficients of p on [a,b] enclose its values: if all are positive, so is p. If one
/// is not, [a,b] is halved. A p that is positive on [a,b] is proved so at some depth, about the
/// logarithm of the distance of its nearest complex root; a checker halves only so often, so whoever
/// writes a certificate has to know how deep a proof goes and where.

#include <cstdint>
#include <vector>

#include "exact/algebra/number.hpp"
#include "exact/algebra/polynomial.hpp"

namespace touchstone::exact {

/// So often a checker of certificates halves an interval.
inline constexpr unsigned long bisection_limit = 128;

/// The Bernstein coefficients of p on an interval, all multiplied by one positive number.
[[nodiscard]] std::vector<Integer> bernstein_coefficients(const Polynomial& p,
                                                          const RationalInterval& interval);

/// The Bernstein coefficients on [0,1] of the form Σ c_k (1−t)^(n−k) t^k (exact/contact/corner_motion.hpp), all
/// multiplied by one positive number.
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
  /// The deepest part that was looked at, where the outcome is `positive`: part number `index` of
  /// the 2^depth equal ones. The first of several.
  unsigned long depth = 0;
  Integer index = 0;
};

/// Looks whether the polynomial with these Bernstein coefficients is positive on the closed interval
/// that they belong to, halving it up to `limit` times.
[[nodiscard]] BisectionProof prove_positive(const std::vector<Integer>& bernstein,
                                            unsigned long limit = bisection_limit);

}  // namespace touchstone::exact

#pragma once

/// \file
/// The least distance of the primitives of a query without collision, decided by the oracle.
///
/// The query collides at distance d in L2 iff the least distance is at most d (docs/theory.md,
/// section 1.4), so bisection over the doubles encloses it between two neighbouring ones. The time
/// of impact at the upper one is the first time with at most that distance.

#include <optional>

#include "touchstone/algebraic_number.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::view {

/// The least distance in L2 over t ∈ [0,1].
struct NearestApproach {
  double above = 0.0;    ///< a lower bound, exclusive, ≥ 0
  double at_most = 0.0;  ///< the next double, an upper bound
  /// The first time with a distance of at most `at_most`.
  exact::AlgebraicNumber time;
};

/// Empty if the query collides, or the distance is greater than every double.
/// \throws std::domain_error if a coordinate is NaN or infinite.
[[nodiscard]] std::optional<NearestApproach> nearest_approach(Kind kind, const Query& query);

}  // namespace touchstone::verify::view

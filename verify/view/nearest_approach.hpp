#pragma once

/// \file
/// How near the primitives of a query come that do not touch, decided by the oracle.
///
/// The query collides at distance d in L2 iff the primitives come as near as d (docs/theory.md, section
/// 1.4), so bisection over the doubles encloses the least distance between two neighbouring ones. The time of impact at the
/// upper one is the first time at which they are that near.

#include <optional>

#include "exact/algebra/algebraic_number.hpp"
#include "exact/query.hpp"

namespace touchstone::verify::view {

/// The least distance in L2 over t ∈ [0,1].
struct NearestApproach {
  double above = 0.0;    ///< it is greater than this double, 0 or more
  double at_most = 0.0;  ///< and at most this one, the next
  /// The first time at which they are as near as `at_most`.
  exact::AlgebraicNumber time;
};

/// Nothing if they touch, or the distance is greater than every double.
/// \throws std::invalid_argument if a coordinate is NaN or infinite.
[[nodiscard]] std::optional<NearestApproach> nearest_approach(Kind kind, const Query& query);

}  // namespace touchstone::verify::view

#pragma once

/// \file
/// The distance of two primitives at a time, in floating point with proof, or no answer.
///
/// The expressions of polygon_features.hpp are evaluated in balls (filters/ball.hpp). The nearest
/// feature is guessed in doubles. A double s is shown to be below the distance by that feature's
/// direction (theorem 2), or by its axis (theorem 3), and above it by any feature that is certainly
/// attained (theorem 1), or by all axes. Both are asked of neighbouring doubles.
///
/// In L2, ties of features do no harm: if the foot of a perpendicular is just on the boundary of a
/// feature, so that nobody can say whether it is inside, what bounds the feature is as near.

#include <optional>

#include "exact/query.hpp"
#include "fast/distance.hpp"

namespace touchstone::fast {

/// As `distance`, or nothing if rounding, overflow or underflow leave it open, as they do in L2 if the
/// distance is a double. Under strict floating point.
/// \pre All coordinates are finite; 0 ≤ t ≤ 1.
[[nodiscard]] std::optional<Distance> filtered_distance(Kind kind, const Query& query, double t,
                                                        Norm norm);

}  // namespace touchstone::fast

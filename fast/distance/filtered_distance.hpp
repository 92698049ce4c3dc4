#pragma once

/// \file
/// The distance of two primitives at a time, proved in floating point, or no answer.
///
/// The expressions of polygon_features.hpp are evaluated in balls (touchstone/filters/ball.hpp).
/// The nearest feature is guessed in doubles. That feature's direction (theorem 2) or axis (theorem
/// 3) proves that a double s is below the distance; any feature that is certainly attained (theorem
/// 1), or all axes together, prove that it is above. Neighbouring doubles are compared in this way.
///
/// In L2, ties of features are harmless: if the foot of a perpendicular is on the boundary of a
/// feature, and rounding hides whether it is inside, the boundary of the feature has the same
/// distance.

#include <optional>

#include "touchstone/contacts.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The same as `distance`; empty if rounding, overflow or underflow leave it open: in L2 also if
/// the distance is a double.
/// \pre Strict floating point; all coordinates are finite; 0 ≤ t ≤ 1.
[[nodiscard]] std::optional<Distance> filtered_distance(ContactKind kind, const Query& query,
                                                        double t, Norm norm);

}  // namespace touchstone::fast

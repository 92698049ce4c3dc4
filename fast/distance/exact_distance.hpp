#pragma once

/// \file
/// The distance of two primitives at a time, in integers: exact for all finite doubles.
///
/// Coordinates are multiplied by one power of two that makes them integers. With t = n / 2^k the
/// corners, multiplied by 2^k, are integers too. Theorem 1 and theorem 3 of polygon_features.hpp
/// then give the distance, or its square, as a fraction, which is compared with doubles.

#include "touchstone/contacts.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The same as `distance`.
/// \pre Strict floating point; all coordinates are finite; 0 ≤ t ≤ 1.
[[nodiscard]] Distance exact_distance(ContactKind kind, const Query& query, double t, Norm norm);

}  // namespace touchstone::fast

#pragma once

/// \file
/// The moving polygon of a query on curves, in integers.
///
/// All coordinates have one unit, a power of two, and the weights of a point another. The points
/// are multiplied by the product of all denominators, equal ones once (docs/theory.md,
/// section 2.5).

#include "fast/certified/exact/distance_decision.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

struct CurvedPolygon {
  MovingPolygon polygon;
  ScaledDistance distance;
};

/// \pre is_valid(query)
[[nodiscard]] CurvedPolygon polygon_of(Kind kind, const CurvedQuery& query, double distance);

/// True if all coordinates are finite, and all weights positive and finite, as many as control
/// points or none.
[[nodiscard]] bool is_valid(const CurvedQuery& query);

/// The query at a time, at rest: an approximation.
[[nodiscard]] Query at_rest(const CurvedQuery& query, double time);

}  // namespace touchstone::fast::exact_stage

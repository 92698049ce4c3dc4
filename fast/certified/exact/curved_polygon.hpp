#pragma once

/// \file
/// The moving polygon of a query on curves, in integers.
///
/// The coordinates of each axis have one unit, a power of two, and the weights of each point
/// another. With a distance all axes have the same unit, and each point is a fraction with its own
/// denominator (docs/theory.md, section 6.15). Without one, the points are multiplied by the
/// product of all denominators, equal ones once (section 2.5).
///
/// With three or four denominators, degrees and numbers are smaller if each corner is multiplied
/// only by those of its two points. A triangle contains the origin for any positive factors of its
/// corners or for none; a parallelogram is the union of two triangles.
///
/// The determinant of three corners that have all four points is, up to its sign, that of the
/// points with a fourth coordinate 1. Times the denominators of the four points it is a polynomial.
/// So the other denominators of the corners divide it.

#include <optional>
#include <vector>

#include "fast/certified/exact/distance_decision.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// Points as fractions, with the data that they refer to. Move it, do not copy it.
struct CurvedPoints {
  MovingPoints points;
  std::vector<Polynomial> denominators;
  ScaledDistance distance;
};

/// \pre is_valid(query), distance > 0
[[nodiscard]] CurvedPoints points_of(ContactKind kind, const CurvedQuery& query, double distance);

/// Motions of which one contains the origin iff the query is in contact. \pre is_valid(query)
[[nodiscard]] std::vector<PolynomialMotion> motions_of(ContactKind kind, const CurvedQuery& query);

/// The same query on straight lines, if all its curves are polynomial and of a degree up to 1.
[[nodiscard]] std::optional<Query> on_lines(const CurvedQuery& query);

/// True if all coordinates are finite, and all weights positive and finite, as many as control
/// points or none.
[[nodiscard]] bool is_valid(const CurvedQuery& query);

/// The query at a time, at rest: an approximation.
[[nodiscard]] Query at_rest(const CurvedQuery& query, double time);

}  // namespace touchstone::fast::exact_stage

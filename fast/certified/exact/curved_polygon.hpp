#pragma once

/// \file
/// The moving polygon of a query on curves, in integers.
///
/// The coordinates of each axis have one unit, a power of two, and the weights of a point another.
/// With a distance all axes have the same, and the points are fractions with denominators of their
/// own (docs/theory.md, section 6.15). Without one the points are multiplied by the product of all
/// denominators, equal ones once (section 2.5).
///
/// With three or four denominators the degrees and the numbers are shorter if each corner is
/// multiplied by those of its two points alone. Factors of their own keep a triangle that contains
/// the origin one that does; a parallelogram is the union of two.
///
/// The determinant of three corners that have all four points is, up to its sign, that of the
/// points with a fourth coordinate 1. Times the denominators of the four points it is a polynomial.
/// So the other denominators that the corners have been multiplied by divide it.

#include <optional>
#include <vector>

#include "fast/certified/exact/distance_decision.hpp"
#include "fast/certified/exact/general_contact_decision.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// Points as fractions, and what they refer to: to be moved, not copied.
struct CurvedPoints {
  MovingPoints points;
  std::vector<Polynomial> denominators;
  ScaledDistance distance;
};

/// \pre is_valid(query), distance > 0
[[nodiscard]] CurvedPoints points_of(Kind kind, const CurvedQuery& query, double distance);

/// Motions one of which contains the origin where the query is in contact. \pre is_valid(query)
[[nodiscard]] std::vector<PolynomialMotion> motions_of(Kind kind, const CurvedQuery& query);

/// The same query on straight lines, if all its curves are polynomial and of a degree up to 1.
[[nodiscard]] std::optional<Query> on_lines(const CurvedQuery& query);

/// True if all coordinates are finite, and all weights positive and finite, as many as control
/// points or none.
[[nodiscard]] bool is_valid(const CurvedQuery& query);

/// The query at a time, at rest: an approximation.
[[nodiscard]] Query at_rest(const CurvedQuery& query, double time);

}  // namespace touchstone::fast::exact_stage

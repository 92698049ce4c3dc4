#pragma once

/// \file
/// The intersection of two triangles at rest, by rational arithmetic alone.
///
/// A triangle is the convex hull of three points; it may be a segment or a point. The second one is
/// the set of all x with f(x) ≥ 0 for some affine functions f: those that are 0 on its plane, line
/// or point, with both signs, and one for each side. The first one is clipped by them one after the
/// other: of its corners in order, those with f ≥ 0 stay, and between two with different signs the
/// point with f = 0 is added. That is the intersection of a convex polygon with a half-space, also
/// of a polygon that is a segment or a point, whose corners are then repeated.

#include <array>
#include <vector>

#include "touchstone/number.hpp"

namespace touchstone::exact {

using RationalPoint = std::array<Rational, 3>;
using RationalTriangle = std::array<RationalPoint, 3>;

/// The corners of the intersection, each once; empty if there is none.
[[nodiscard]] std::vector<RationalPoint> intersection_of(const RationalTriangle& a,
                                                         const RationalTriangle& b);

}  // namespace touchstone::exact

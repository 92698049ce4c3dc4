#pragma once

/// \file
/// Contacts as people have them: at the very beginning or end of a step, at features that both
/// primitives share, with coordinates up to 1e-3, 1e-2, … or 1e4 that are short decimals, as people type them and
/// exporters print them.
///
/// **Why they touch.** A scene is placed at one end of the step in whole units. There either a point of
/// one primitive is a point of the other, or lies on a side of it along an axis, or both lie in one
/// plane across an axis, one point inside the triangle or the edges across each other, by more than a
/// unit. The unit is a power of ten, and each coordinate the double nearest to that decimal, or to the
/// float nearest to it. Rounding keeps order and equality of coordinates, hence the contact.

#include "exact/query.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// A query that touches at t=0 or at t=1, and may touch earlier too; of those that share a point then,
/// half share it all the time. Coordinates are decimals of at most six digits, or the floats nearest to
/// them; the greatest is from 1e-4 to 1e4 in magnitude.
[[nodiscard]] Query everyday_contact(Kind kind, generate::Random& random);

/// The same, but at the end of the contact the first primitive is a unit away on one axis.
[[nodiscard]] Query everyday_near_miss(Kind kind, generate::Random& random);

}  // namespace touchstone::verify::fuzz

#pragma once

/// \file
/// Queries with contact by construction: solvers fail close to them.
///
/// **On a grid.** All points are placed at a time n/2^k at integer positions: the vertex at an
/// integer combination of the face, the edges through one point. With integer velocities e per 2^-k
/// of time, x(0) = x − n·e and x(1) = x + (2^k − n)·e are integers below 2^53, and F vanishes at
/// that time. Then each axis is multiplied by a power of two.
///
/// **Level.** The first primitive has the height p(t) in z at all of its points, the second q(t).
/// The projections to x and y meet at all times (inside, on a side, or on a corner with the same
/// double in both), and p − q has a zero in [0,1]. Rounding keeps order and equality, so
/// significands may be full, and the scale of each axis any number.
///
/// An exact symmetry is then applied (symmetry.hpp).

#include "touchstone/any_kind.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

/// A query on a grid that collides.
[[nodiscard]] Query grid_contact(ContactKind kind, generate::Random& random);

/// A level query that collides.
[[nodiscard]] Query level_contact(ContactKind kind, generate::Random& random);

/// A query with full significands, one point of which is placed at F = 0 and rounded: a collision,
/// or barely none.
[[nodiscard]] Query rounded_contact(ContactKind kind, generate::Random& random);

/// Level primitives whose nearest heights differ by the distance of the separation, rounded; or a
/// contact as above, one primitive of which is moved by as much, in a direction that often has few
/// bits. \pre distance > 0
[[nodiscard]] Query contact_apart(ContactKind kind, const Separation& separation,
                                  generate::Random& random);

}  // namespace touchstone::verify::fuzz

#pragma once

/// \file
/// Contacts of two edges for which all roundings of one coordinate have the same direction.
///
/// At a contact the computed value of F = A − B is the sum of many rounding errors, and for random
/// points it is far below a bound for all. Here the positions of edge a at the dyadic time c are
/// rounded up nearly as much as possible, and those of edge b down: the error is more than a third
/// of Tight-Inclusion's filter for edges.

#include "touchstone/query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

/// Two edges that meet at a time just after c, one of 33/64 and 31/64, and on one axis are computed
/// to be apart by some 4 u x at c (u: 2^-53, x: the greatest coordinate there), for any u and v.
[[nodiscard]] Query aligned_contact(generate::Random& random);

}  // namespace touchstone::verify::fuzz

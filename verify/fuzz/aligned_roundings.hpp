#pragma once

/// \file
/// Contact of two edges where the roundings of one coordinate all go to one side.
///
/// What a solver computes of F = A − B at a contact is the sum of the errors of many roundings, and
/// that of random ones is far below a bound that holds for all. Here the points of edge a are such
/// that their positions at the dyadic time c are rounded up by nearly as much as can be, and those
/// of edge b down: more than a third of what Tight-Inclusion's filter of edges allows for.

#include "exact/query.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz {

/// Two edges that meet at a time just after c, one of 33/64 and 31/64, and on one axis are computed
/// to be apart by some 4 u x at c (u: 2^-53, x: the greatest coordinate there), before u and v are
/// looked at.
[[nodiscard]] Query aligned_contact(generate::Random& random);

}  // namespace touchstone::verify::fuzz

#pragma once

/// \file
/// Small perturbations of queries that solvers handled well or just failed.

#include <cstdint>

#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz {

/// The double at this number of doubles above x (below, if negative), limited to the greatest
/// finite magnitude. \pre x is finite
[[nodiscard]] double stepped(double x, std::int64_t steps);

/// Moves one to three coordinates by some units in the last place: mostly a few, sometimes 2^k. All
/// coordinates stay finite.
void nudge(Query& query, generate::Random& random);

/// Moves the points at one end by up to 2^-20 of their way, forwards or backwards: an event at that
/// end then happens slightly earlier or not at all. All points, or the first primitive's. All
/// coordinates stay finite.
void overshoot(Kind kind, Query& query, generate::Random& random);

/// One to three changes: a bit flipped, coordinates or points copied or exchanged, a sign changed,
/// a coordinate set to 0, rounded to few bits or multiplied by a power of two, units in the last
/// place, a point at rest. Weights are changed as coordinates are, if they may be. All coordinates
/// stay finite, all weights between 2^-40 and 2^40.
[[nodiscard]] base::AnyQuery mutated(const base::AnyQuery& query, bool changes_weights,
                                     generate::Random& random);

}  // namespace touchstone::verify::fuzz

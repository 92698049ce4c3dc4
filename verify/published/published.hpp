#pragma once

/// \file
/// Common parts of the published methods: their answers, and the stream of those that draw random
/// directions.
///
/// Each method NAME is a function `Answer NAME(ContactKind, const Query&, const
/// TouchstonePluginOptions&)` in a source whose comment says its idea, its promise and its known
/// defects; plugin.cpp makes it a plugin. It is called with finite coordinates, rounding to
/// nearest, and may change the rounding mode as long as it runs. What it throws counts as a
/// collision.

#include <bit>
#include <cstdint>

#include "touchstone/certified.hpp"
#include "touchstone/plugin.h"
#include "touchstone/query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::published {

struct Answer {
  TouchstoneVerdict verdict = TOUCHSTONE_NO;
  double toi = fast::no_number;  ///< claimed: not above the exact time of impact; only with yes
  double tolerance = fast::no_number;  ///< of TouchstonePluginAnswer
};

[[nodiscard]] inline Answer yes_if(bool collides) {
  return {collides ? TOUCHSTONE_YES : TOUCHSTONE_NO};
}

/// Its seed is the query's own bits, so a query gets the same answer every time, in any order and
/// in any thread.
[[nodiscard]] inline generate::Random random_of(const Query& query) {
  std::uint64_t seed = generate::Random::golden_ratio;
  for (const double x : query.coordinates) {
    seed = generate::mix(seed ^ std::bit_cast<std::uint64_t>(x));
  }
  return generate::Random(seed);
}

}  // namespace touchstone::verify::published

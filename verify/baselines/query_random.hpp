#pragma once

/// \file
/// Random numbers for methods that try random directions. The seed is the query's own bits, so a
/// query gets the same answer every time, in any order and in any thread.

#include <bit>
#include <cstdint>

#include "touchstone/query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::baselines {

using Random = verify::generate::Random;

/// The stream of a query.
[[nodiscard]] inline Random random_of(const Query& query) {
  std::uint64_t seed = Random::golden_ratio;
  for (const double x : query.coordinates) {
    seed = verify::generate::mix(seed ^ std::bit_cast<std::uint64_t>(x));
  }
  return Random(seed);
}

}  // namespace touchstone::baselines

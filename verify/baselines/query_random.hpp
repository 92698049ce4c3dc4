#pragma once

/// \file
/// Random numbers for methods that try random directions. The seed is the query's own bits, so a
/// query gets the same answer every time, in any order and in any thread.

#include <bit>
#include <cmath>
#include <cstdint>

#include "exact/query.hpp"

namespace touchstone::baselines {

/// splitmix64 [steele2014], seeded with a query.
class QueryRandom {
 public:
  explicit QueryRandom(const Query& query) {
    for (const double x : query.coordinates)
      state_ = mixed(state_ ^ std::bit_cast<std::uint64_t>(x));
  }

  /// A multiple of 2^-53 times the width, in [lower, upper).
  [[nodiscard]] double uniform(double lower, double upper) {
    state_ += golden_ratio;
    const double unit = std::ldexp(static_cast<double>(mixed(state_) >> 11U), -53);
    return lower + (upper - lower) * unit;
  }

 private:
  static constexpr std::uint64_t golden_ratio = 0x9E3779B97F4A7C15U;

  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31U);
  }

  std::uint64_t state_ = golden_ratio;
};

}  // namespace touchstone::baselines

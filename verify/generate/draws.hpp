#pragma once

/// \file
/// Common random draws of the fuzzer's generators.

#include <array>
#include <cmath>
#include <cstddef>

#include "touchstone/query.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate::draws {

/// Uniform among 0 … count − 1. \pre count > 0
[[nodiscard]] inline std::size_t below(Random& random, std::size_t count) {
  return static_cast<std::size_t>(random.bits() % count);
}

/// True with probability 1/n.
[[nodiscard]] inline bool one_in(Random& random, std::size_t count) {
  return below(random, count) == 0;
}

/// 2^k, −1074 ≤ k ≤ 1023.
[[nodiscard]] inline double power_of_two(int exponent) { return std::ldexp(1.0, exponent); }

/// A scale of coordinates: 1, a power of two, of ten, or any number; mostly moderate.
[[nodiscard]] inline double scale(Random& random) {
  static constexpr std::array<double, 9> decimal{1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4};
  switch (below(random, 4)) {
    case 0:
      return 1.0;
    case 1:
      return power_of_two(static_cast<int>(random.between(-30, 30)));
    case 2:
      return decimal.at(below(random, decimal.size()));
    default: {
      const double power = power_of_two(static_cast<int>(random.between(-12, 12)));
      return random.uniform(1.0, 2.0) * power;
    }
  }
}

/// Scales of the three axes, mostly the same one.
[[nodiscard]] inline std::array<double, 3> scales(Random& random) {
  const double common = scale(random);
  if (!one_in(random, 4)) return {common, common, common};
  const double second = scale(random);
  return {common, second, scale(random)};
}

/// Multiplies each axis.
inline void multiply(Query& query, const std::array<double, 3>& factors) {
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    query.coordinates.at(i) *= factors.at(i % 3);
  }
}

}  // namespace touchstone::verify::generate::draws

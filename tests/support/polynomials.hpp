#pragma once

/// \file
/// Polynomials in Bernstein's basis, in rationals.

#include <cstddef>
#include <vector>

#include "touchstone/number.hpp"

namespace touchstone::tests {

/// Bernstein's coefficients on [lower, upper] of those on [0,1], by de Casteljau's steps.
[[nodiscard]] inline std::vector<exact::Rational> bernstein_on(
    const std::vector<exact::Rational>& b, const exact::Rational& lower,
    const exact::Rational& upper) {
  std::vector<exact::Rational> result;
  for (std::size_t k = 0; k < b.size(); ++k) {
    std::vector<exact::Rational> x = b;
    for (std::size_t left = b.size() - 1; left > 0; --left) {
      const exact::Rational& t = left > k ? lower : upper;
      for (std::size_t i = 0; i < left; ++i) x[i] = (1 - t) * x[i] + t * x[i + 1];
    }
    result.push_back(x[0]);
  }
  return result;
}

}  // namespace touchstone::tests

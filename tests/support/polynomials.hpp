#pragma once

/// \file
/// Integer polynomials for tests.

#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::tests {

/// Σ c_i t^i.
[[nodiscard]] inline exact::Polynomial polynomial(const std::vector<exact::Integer>& c) {
  return exact::Polynomial(c);
}

[[nodiscard]] inline exact::Polynomial power(const exact::Polynomial& p, int exponent) {
  exact::Polynomial result = polynomial({1});
  for (int i = 0; i < exponent; ++i) result = result * p;
  return result;
}

/// A primitive polynomial of degree 1 with this root.
[[nodiscard]] inline exact::Polynomial factor(const exact::Rational& root) {
  return polynomial({-root.get_num(), root.get_den()});
}

/// A random polynomial of exactly this degree.
[[nodiscard]] inline exact::Polynomial random_polynomial(Random& random, int degree,
                                                         unsigned bits) {
  std::vector<exact::Integer> c;
  for (int i = 0; i <= degree; ++i) c.push_back(random.integer<exact::Integer>(bits));
  if (sgn(c.back()) == 0) c.back() = 1;
  return polynomial(c);
}

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

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

}  // namespace touchstone::tests

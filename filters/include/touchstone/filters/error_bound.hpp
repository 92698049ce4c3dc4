#pragma once

/// \file
/// The interface of a derived error bound for the code that uses it.

#include <array>
#include <cstddef>

#include "touchstone/filters/strict_arithmetic.hpp"

namespace touchstone::filters {

/// |computed − exact| ≤ Σ_j coefficients[j] x^j for all coordinates of magnitude up to x, all
/// weights of the expression's groups, and x ≤ greatest_x, where nothing overflows. The last
/// coefficient is the rounding error, the others are underflow.
///
/// If an expression has classes (each of its products has one coordinate of each class), the
/// greatest magnitudes x_1, x_2, … of the classes bound the rounding error more tightly:
/// |computed − exact| ≤ rounding() · x_1 · x_2 ⋯ + underflow(x) for any x ≥ max x_i, computed in
/// Scalar, the products in any order. For an expression of measured coordinates
/// (touchstone/filters/polynomial_expressions.hpp) the x_i are the magnitudes of the rounded ones.
template <class Scalar, std::size_t degree>
struct ErrorBound {
  std::array<Scalar, degree + 1> coefficients;
  Scalar greatest_x;

  /// The bound at x, itself computed in Scalar: the coefficients are large enough to cover that.
  /// \pre 0 ≤ x ≤ greatest_x.
  [[nodiscard]] constexpr Scalar operator()(Scalar x) const {
    Scalar bound = coefficients[degree];
    for (std::size_t j = degree; j-- > 0;) bound = bound * x + coefficients[j];
    return bound;
  }

  /// The factor of the greatest power of x.
  [[nodiscard]] constexpr Scalar rounding() const { return coefficients[degree]; }

  /// The underflow part of the bound at x.
  [[nodiscard]] constexpr Scalar underflow(Scalar x) const {
    Scalar bound = 0;
    for (std::size_t j = degree; j-- > 0;) bound = bound * x + coefficients[j];
    return bound;
  }
};

}  // namespace touchstone::filters

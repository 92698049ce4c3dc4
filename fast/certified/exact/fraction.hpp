#pragma once

/// \file
/// Fractions of polynomials whose denominators are products of a few known ones.
///
/// The denominators are those of a query's points on rational curves: positive on [0,1], so that
/// the sign of a fraction is that of its numerator. A sum has the least common powers of them, and
/// hence no factor that its terms do not need. Such a factor would have no root in [0,1], but it
/// makes numbers longer and, squared, hides from Descartes' rule that a root is simple.
///
/// Polynomials are forms (polynomial.hpp); one of a lower degree is multiplied by powers of x + y,
/// which is 1.

#include <array>
#include <cstdint>
#include <vector>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/polynomial.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::exact_stage {

/// numerator / Π denominators_i^powers_i. Those of one expression have the same denominators.
struct Fraction {
  Polynomial numerator;
  std::array<std::uint8_t, moving_points> powers{};
  const Polynomial* denominators = nullptr;  ///< null if all powers are 0

  Fraction& operator+=(const Fraction& other);
  Fraction& operator-=(const Fraction& other);
  friend Fraction operator+(Fraction a, const Fraction& b) { return a += b; }
  friend Fraction operator-(Fraction a, const Fraction& b) { return a -= b; }
  friend Fraction operator-(Fraction a);
  friend Fraction operator*(const Fraction& a, const Fraction& b);
  friend Fraction operator*(Fraction a, const BigInteger& factor);
  friend Fraction operator<<(Fraction a, long bits);
};

/// The numerators of the same fractions with common powers and degrees.
[[nodiscard]] std::vector<Polynomial> common_numerators(std::vector<Fraction> fractions);

}  // namespace touchstone::fast::exact_stage

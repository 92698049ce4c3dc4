#pragma once

/// \file
/// How far the value of an expression can be from the truth, proved from its operations.
///
/// **Model.** Operations are rounded to nearest with gradual underflow. With u half the distance of
/// 1 and the next number, and η half the least subnormal,
///
///     fl(a ± b) = (a ± b)(1 + δ),    fl(a · b) = (a · b)(1 + δ) + ε,    |δ| ≤ u,  |ε| ≤ η
///
/// as long as nothing overflows (Higham, Accuracy and Stability, section 2.2; a sum that is
/// subnormal is exact, hence no ε).
///
/// **Theorem.** Let all δ and ε be free in these ranges. For fixed coordinates, δ and ε, both the
/// computed and the exact value are affine in the weights of each group (an expression has no
/// product of two terms with weights of one group). Hence so is their difference, its absolute value
/// is convex in each group, and over a product of polygons it is greatest at a combination of
/// vertices. It therefore suffices to bound the error there, where the weights are known numbers.
///
/// **At a vertex** every node's exact value is a polynomial in the coordinates. It is expanded, so
/// that what cancels is gone, and for coordinates up to x in magnitude is at most
/// B x^k with B the sum of its coefficients' magnitudes, k its degree. Errors follow the graph:
///
///     sum:      e = e_a + e_b,                       product:  e = e_a |b| + |a| e_b + e_a e_b,
///     rounded:  e + u (|value| + e) + η (products)
///
/// Each is a polynomial in x with nonnegative rational coefficients: that of x^k is the rounding
/// error, the lower ones are underflow. Nothing is dropped, all of it is exact rational arithmetic,
/// and the largest coefficients over the vertices make the bound.

#include <gmpxx.h>

#include <vector>

#include "filters/derivation/expression_graph.hpp"

namespace touchstone::filters {

/// 2^exponent.
[[nodiscard]] mpq_class power_of_two(int exponent);

/// 2^⌊log2 x⌋. \pre x > 0.
[[nodiscard]] mpq_class power_of_two_below(const mpq_class& x);

/// A floating-point format.
struct Format {
  const char* name;       ///< "double" or "float"
  int digits;             ///< of the significand, the leading one included
  int least_exponent;     ///< the least positive number is 2^least_exponent
  int greatest_exponent;  ///< the greatest number is below 2^greatest_exponent

  /// u: half the distance of 1 and the next number.
  [[nodiscard]] mpq_class unit_roundoff() const;
};

inline constexpr Format double_format{"double", 53, -1074, 1024};
inline constexpr Format float_format{"float", 24, -149, 128};

/// |computed − exact| ≤ Σ_j coefficients[j] x^j for coordinates of magnitude up to
/// x ≤ 2^greatest_x_exponent, where nothing overflows. The last coefficient is the rounding error,
/// those before are underflow.
struct DerivedBound {
  std::vector<mpq_class> coefficients;
  int greatest_x_exponent = 0;

  [[nodiscard]] const mpq_class& rounding() const { return coefficients.back(); }
};

/// The expanded value of a node at a vertex: monomials (the sorted numbers of their coordinates,
/// repeated as often as the power says) with their coefficients.
struct ExactValue {
  struct Term {
    std::vector<std::size_t> monomial;
    mpq_class coefficient;
  };
  std::vector<Term> terms;  ///< sorted by monomial, none zero

  [[nodiscard]] std::size_t degree() const;
  /// Σ |coefficient|
  [[nodiscard]] mpq_class magnitude() const;
};

/// The exact values of all nodes at a vertex.
[[nodiscard]] std::vector<ExactValue> expand(const ExpressionGraph& graph,
                                             const std::vector<int>& weights);

/// The bound of the model above.
/// \throws std::invalid_argument if a sum in the expression adds terms of different degrees.
[[nodiscard]] DerivedBound derive_bound(const ExpressionGraph& graph, const Format& format);

}  // namespace touchstone::filters

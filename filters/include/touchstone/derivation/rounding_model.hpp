#pragma once

/// \file
/// A bound on the error of an expression's value, proved from its operations.
///
/// **Model.** Operations round to nearest with gradual underflow. With u half the distance between
/// 1 and the next number, and η half the least subnormal,
///
///     fl(a ± b) = (a ± b)(1 + δ),    fl(a · b) = (a · b)(1 + δ) + ε,    |δ| ≤ u,  |ε| ≤ η
///
/// as long as nothing overflows ([higham2002], section 2.2; a sum that is
/// subnormal is exact, hence no ε).
///
/// **Theorem.** Let all δ and ε be free in these ranges. For fixed coordinates, δ and ε, both the
/// computed and the exact value are affine in the weights of each group (an expression has no
/// product of two terms with weights of one group). Hence so is their difference, its absolute
/// value is convex in each group, and over a product of polygons it is greatest at a combination of
/// vertices. It therefore suffices to bound the error at those combinations, where the weights are
/// known numbers.
///
/// **At a vertex** every node's exact value is a polynomial in the coordinates. It is expanded, so
/// that terms cancel. For coordinates up to x in magnitude it is at most B x^k, where B is the sum
/// of its coefficients' magnitudes and k its degree. Errors follow the graph:
///
///     sum:      e = e_a + e_b,                       product:  e = e_a |b| + |a| e_b + e_a e_b,
///     rounded:  e + u (|value| + e) + η (products)
///
/// Each is a polynomial in x with nonnegative rational coefficients: that of x^k is the rounding
/// error, the lower ones are underflow. No term is dropped, the arithmetic is exact and rational,
/// and the bound has the largest coefficients over the vertices.
///
/// **Classes.** Let the coordinates be in classes such that every product of coordinates in the
/// value of a node has one coordinate of each class of a set S of that node (require_classes), and
/// let x_i be the greatest magnitude in class i, x the greatest of all. Then the coefficient of x^k
/// in an error, k = |S|, may be read as the coefficient of Π x_i over S, while the others remain:
/// the exact value is at most B Π x_i, and the property is preserved along the graph. In a sum, S
/// is the set of both operands. In a product the sets are disjoint, so that the leading terms of
/// e_a |b|, |a| e_b and e_a e_b have Π over S_a times Π over S_b, each class once; in every other
/// term one factor is an underflow term, of lower degree, and Π x_i ≤ x^k bounds the other one.
/// Rounding multiplies terms of this form by u, and its η is of degree 0. (The vertices are as
/// before: the theorem holds for fixed coordinates.)
///
/// **Measured coordinates.** A coordinate that was rounded before, x (1 + δ) instead of x, is a
/// product with a weight that is 1, the only vertex of its own group. (Differences of numbers are
/// rounded in this way. They do not underflow; the model counts the product's underflow
/// nevertheless.)

#include <gmpxx.h>

#include <vector>

#include "touchstone/derivation/expression_graph.hpp"

namespace touchstone::filters {

/// 2^exponent.
[[nodiscard]] mpq_class power_of_two(int exponent);

/// 2^⌊log2 x⌋. \pre x > 0.
[[nodiscard]] mpq_class power_of_two_below(const mpq_class& x);

/// A floating-point format.
struct Format {
  const char* name;       ///< "double", "float" or "double_double"
  int digits;             ///< of the significand, the leading one included
  int least_exponent;     ///< the least positive number is 2^least_exponent
  int greatest_exponent;  ///< the greatest number is below 2^greatest_exponent

  /// u: half the distance between 1 and the next number.
  [[nodiscard]] mpq_class unit_roundoff() const;
};

inline constexpr Format double_format{"double", 53, -1074, 1024};
inline constexpr Format float_format{"float", 24, -149, 128};
/// Pairs of doubles (touchstone/filters/double_double.hpp). They have no fixed number of digits,
/// but the errors of their operations are at most those of this format.
inline constexpr Format double_double_format{"double_double", 103, -1070, 990};

/// The format of the bounds for a format, in which code compares.
[[nodiscard]] constexpr const Format& format_of_bounds(const Format& format) {
  return format.digits < double_format.digits ? float_format : double_format;
}

/// |computed − exact| ≤ Σ_j coefficients[j] x^j for coordinates of magnitude up to x ≤
/// 2^greatest_x_exponent, where nothing overflows. The last coefficient is the rounding error, the
/// others are underflow.
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

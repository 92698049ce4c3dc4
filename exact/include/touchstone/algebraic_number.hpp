#pragma once

/// \file
/// Real algebraic numbers in [0,1]: exact, comparable, and as precise as asked.
///
/// A number α is a squarefree integer polynomial p and a cell with rational ends in which α is p's
/// only root (or, where α is known to be rational, its value). Everything else follows:
///
/// - *Refinement.* p changes sign across the cell, so one sign of p halves it. Quadratic interval
///   refinement [abbott2006] guesses where the secant crosses zero and asks for two signs there; a
///   right guess doubles the number of bits that the next guess gains, a wrong one halves it.
/// - *Sign of q(α).* If the Bernstein form of q has no sign change on the cell, its sign is the
///   sign of q(α). Otherwise refine; this ends unless q(α) = 0, which holds iff α is a root of
///   gcd(p,q), that is iff this divisor changes sign across the cell.
/// - *Comparison.* Refine until the cells are disjoint; this ends unless the numbers are equal,
///   which holds iff the gcd of their polynomials has a root in the intersection of the cells.

#include <compare>
#include <optional>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/polynomial.hpp"

namespace touchstone::exact {

/// A real algebraic number, by default 0. Copies are independent. Thread-safe as standard types
/// are: several threads can call const functions of an object, or any functions of distinct
/// objects.
class AlgebraicNumber {
 public:
  /// A rational number, known as such.
  explicit AlgebraicNumber(const Rational& value = 0);

  /// The only root of `squarefree` in the open cell.
  /// \pre there is exactly one, it is simple, and the ends of the cell are no roots.
  AlgebraicNumber(Polynomial squarefree, DyadicCell cell);

  /// A squarefree integer polynomial that has this number as a root.
  [[nodiscard]] const Polynomial& polynomial() const { return polynomial_; }

  /// The value, if this number is known to be rational. A rational root of a polynomial of degree 2
  /// or more is recognised when refinement meets it, as it does for every dyadic number.
  [[nodiscard]] const std::optional<Rational>& rational() const { return rational_; }

  /// The isolating interval: both ends equal the number, or it is the polynomial's only root
  /// between them and strictly inside.
  [[nodiscard]] RationalInterval interval() const;

  /// Narrows the isolating interval to at most `width` > 0.
  /// \throws std::invalid_argument if it is not positive.
  void refine(const Rational& width);

  /// Narrows the isolating interval to at most 2^-level.
  void refine_to_level(unsigned long level);

  /// Sign (−1, 0, 1) of q at this number. Refines as far as that takes.
  [[nodiscard]] int sign_of(const Polynomial& q);

  /// True if q is zero at this number. Faster than sign_of if the answer is expected to be true.
  [[nodiscard]] bool is_root_of(const Polynomial& q) const;

  /// Neighbouring doubles around this number, or the double that it is: lower ≤ α ≤ upper.
  [[nodiscard]] DoubleInterval enclosure() const;

  friend std::strong_ordering operator<=>(const AlgebraicNumber& a, const Rational& b);
  friend bool operator==(const AlgebraicNumber& a, const Rational& b) { return (a <=> b) == 0; }
  friend std::strong_ordering operator<=>(const AlgebraicNumber& a, const AlgebraicNumber& b);

  /// Compares as <=>, but keeps the refinements: faster if the same numbers are compared again.
  friend std::strong_ordering compare(AlgebraicNumber& x, AlgebraicNumber& y);
  friend bool operator==(const AlgebraicNumber& a, const AlgebraicNumber& b) {
    return (a <=> b) == 0;
  }

 private:
  [[nodiscard]] bool narrow(unsigned long bits);
  void halve();

  Polynomial polynomial_;
  DyadicCell cell_;
  std::optional<Rational> rational_;
  int sign_below_ = 0;  // of the polynomial, between the cell's lower end and the number
};

/// All roots of p ≠ 0 in [0,1], ascending, each once. Roots at dyadic numbers that the isolation
/// meets, and roots of linear factors that it splits off, are known to be rational.
/// \throws std::invalid_argument if p is the zero polynomial.
[[nodiscard]] std::vector<AlgebraicNumber> roots_in_unit_interval(const Polynomial& p);

/// An interval of at most `width` > 0 around numerator(α)/denominator(α); both ends equal and exact
/// where α is known to be rational.
/// \pre denominator(α) ≠ 0. \throws std::invalid_argument if the width is not positive.
[[nodiscard]] RationalInterval enclose_quotient(const Polynomial& numerator,
                                                const Polynomial& denominator,
                                                AlgebraicNumber alpha, const Rational& width);

}  // namespace touchstone::exact

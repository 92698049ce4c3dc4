#pragma once

/// \file
/// Integer polynomials in one variable: the few exact operations that root isolation rests on.
///
/// A polynomial stands in the monomial basis. On a cell [m/2^k, (m+1)/2^k] it is looked at through
/// its *Bernstein form*: with s and y the distances to the upper and lower end, p = Σ c_j s^(n−j)
/// y^j. The c_j are binomial multiples of the Bernstein coefficients, so (Descartes, Bernstein) the
/// number of sign changes among them bounds the number of roots in the open cell and has its
/// parity; none means no root and the sign of the c_j throughout, one means exactly one root.

#include <CGAL/Polynomial.h>
#include <CGAL/gmpxx.h>

#include <vector>

#include "exact/number.hpp"

namespace touchstone::exact {

/// CGAL's polynomial over the integers; the zero polynomial has degree 0 and `is_zero()`.
using Polynomial = CGAL::Polynomial<Integer>;

/// The cell [index/2^level, (index+1)/2^level].
struct DyadicCell {
  Integer index = 0;
  unsigned long level = 0;

  [[nodiscard]] Rational lower() const;
  [[nodiscard]] Rational upper() const;
};

/// Sign (−1, 0, 1) of p(x).
[[nodiscard]] int sign_at(const Polynomial& p, const Rational& x);

/// The coefficients of y ↦ 2^(n·level) p((index + y)/2^level), n the degree: p seen from the cell,
/// y ∈ [0,1].
[[nodiscard]] std::vector<Integer> local_coefficients(const Polynomial& p, const DyadicCell& cell);

/// The coefficients c_0..c_n of p's Bernstein form on a cell, all multiplied by one positive
/// number.
[[nodiscard]] std::vector<Integer> bernstein_form(const Polynomial& p, const DyadicCell& cell);

/// Number of sign changes in a sequence, zeros left out.
[[nodiscard]] int sign_changes(const std::vector<Integer>& coefficients);

/// Sign that p is proved to have on all of the open cell by its Bernstein form, or 0 if that proves
/// none.
[[nodiscard]] int sign_on(const Polynomial& p, const DyadicCell& cell);

/// p divided by its content, with positive leading coefficient. The zero polynomial is returned as
/// is.
[[nodiscard]] Polynomial primitive_part(const Polynomial& p);

/// A primitive greatest common divisor over the rationals, with positive leading coefficient.
[[nodiscard]] Polynomial greatest_common_divisor(const Polynomial& p, const Polynomial& q);

/// The primitive polynomial with the same roots as p ≠ 0, all of them simple.
[[nodiscard]] Polynomial squarefree_part(const Polynomial& p);

/// Remainder of a positive multiple of p under division by q, q of degree at least 1.
[[nodiscard]] Polynomial pseudo_remainder(const Polynomial& p, const Polynomial& q);

/// p / q, where q divides p over the rationals and is primitive.
[[nodiscard]] Polynomial exact_quotient(const Polynomial& p, const Polynomial& q);

}  // namespace touchstone::exact

#pragma once

/// \file
/// Integer polynomials in one variable: the few exact operations that root isolation rests on.
///
/// A polynomial is stored in the monomial basis. On a cell [m/2^k, (m+1)/2^k] its *Bernstein form*
/// is used: with s and y the distances to the upper and lower end, p = Σ c_j s^(n−j) y^j. The c_j
/// are binomial multiples of the Bernstein coefficients, so (Descartes, Bernstein) the number of
/// sign changes among them bounds the number of roots in the open cell and has its parity; no
/// change means no root and the sign of the c_j throughout, one change means exactly one root.
///
/// All functions are thread-safe; a polynomial that no thread changes can be read by several.

#include <concepts>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <vector>

#include "touchstone/number.hpp"

namespace touchstone::exact {

/// A polynomial with integer coefficients and no leading zeros; the zero polynomial is the constant
/// 0.
///
/// CGAL::Polynomial is not used: its copies share one representation, whose reference count is not
/// atomic in CGAL 5.5, so verdicts could not be used by several threads.
class Polynomial {
 public:
  /// Zero.
  Polynomial() : coefficients_(1) {}

  /// Coefficients from the constant one upwards.
  explicit Polynomial(std::vector<Integer> coefficients);
  template <std::same_as<Integer>... Rest>
  explicit Polynomial(const Integer& constant, const Rest&... rest)
      : Polynomial(std::vector<Integer>{constant, rest...}) {}

  /// 0 for a constant, zero included.
  [[nodiscard]] std::size_t degree() const { return coefficients_.size() - 1; }
  [[nodiscard]] bool is_zero() const { return degree() == 0 && sgn(coefficients_.front()) == 0; }
  [[nodiscard]] const Integer& operator[](std::size_t i) const { return coefficients_[i]; }
  [[nodiscard]] const Integer& leading() const { return coefficients_.back(); }

  /// All coefficients, the constant one first; never empty.
  [[nodiscard]] const std::vector<Integer>& coefficients() const { return coefficients_; }

  friend bool operator==(const Polynomial&, const Polynomial&) = default;

 private:
  std::vector<Integer> coefficients_;
};

[[nodiscard]] Polynomial operator-(const Polynomial& p);
[[nodiscard]] Polynomial operator+(const Polynomial& p, const Polynomial& q);
[[nodiscard]] Polynomial operator-(const Polynomial& p, const Polynomial& q);
[[nodiscard]] Polynomial operator*(const Polynomial& p, const Polynomial& q);

/// Writes a sum of terms in t, the highest first: "3 t^2 - t + 5".
std::ostream& operator<<(std::ostream& out, const Polynomial& p);

/// dp/dt.
[[nodiscard]] Polynomial derivative(const Polynomial& p);

/// The cell [index/2^level, (index+1)/2^level].
struct DyadicCell {
  Integer index = 0;
  unsigned long level = 0;

  [[nodiscard]] Rational lower() const;
  [[nodiscard]] Rational upper() const;
};

/// Sign (−1, 0, 1) of p(x).
[[nodiscard]] int sign_at(const Polynomial& p, const Rational& x);

/// The coefficients of y ↦ 2^(n·level) p((index + y)/2^level), n the degree: p in the coordinate y
/// ∈ [0,1] of the cell.
[[nodiscard]] std::vector<Integer> local_coefficients(const Polynomial& p, const DyadicCell& cell);

/// The coefficients c_0..c_n of p's Bernstein form on a cell, all multiplied by one positive
/// number.
[[nodiscard]] std::vector<Integer> bernstein_form(const Polynomial& p, const DyadicCell& cell);

/// Number of sign changes in a sequence, zeros left out.
[[nodiscard]] int sign_changes(const std::vector<Integer>& coefficients);

/// Sign of p on the whole open cell as far as the Bernstein form proves it; 0 if it proves no sign.
[[nodiscard]] int sign_on(const Polynomial& p, const DyadicCell& cell);

/// p divided by its content, with positive leading coefficient. The zero polynomial is returned as
/// is.
[[nodiscard]] Polynomial primitive_part(const Polynomial& p);

/// A primitive greatest common divisor over the rationals, with positive leading coefficient.
[[nodiscard]] Polynomial greatest_common_divisor(const Polynomial& p, const Polynomial& q);

/// The primitive polynomial with the same roots as p ≠ 0, all of them simple.
[[nodiscard]] Polynomial squarefree_part(const Polynomial& p);

/// Remainder of a positive multiple of p under division by q ≠ 0.
[[nodiscard]] Polynomial pseudo_remainder(const Polynomial& p, const Polynomial& q);

/// p / q if q ≠ 0 divides p over the integers (any primitive divisor over the rationals does:
/// Gauss), else nothing.
[[nodiscard]] std::optional<Polynomial> quotient_if_exact(const Polynomial& p, const Polynomial& q);
/// The same. \throws std::invalid_argument if q does not divide p.
[[nodiscard]] Polynomial exact_quotient(const Polynomial& p, const Polynomial& q);

}  // namespace touchstone::exact

#pragma once

/// \file
/// Polynomials whose coefficients are integers of any size, and their common divisors.
///
/// A polynomial is a form Σ c_k x^(n−k) y^k at t = y/(x+y), as in contact_conditions.hpp, of any
/// degree n. It is *inner* if its first and last coefficients are not 0: then it has no roots at
/// t=0 and t=1.
///
/// The divisor is seldom needed: if the polynomials have no common factor modulo some prime that
/// does not divide the first one's top coefficient, they have none. Indeed, the top coefficient of
/// a primitive common factor divides that coefficient, so the factor keeps its degree modulo the
/// prime, where it divides both.

#include <cstddef>
#include <span>
#include <vector>

#include "fast/certified/exact/big_integer.hpp"

namespace touchstone::fast::exact_stage {

/// c_0, …, c_n.
using Polynomial = std::vector<BigInteger>;

// Sums and differences of polynomials of the same degree.
Polynomial& operator+=(Polynomial& a, const Polynomial& b);
Polynomial& operator-=(Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial operator-(Polynomial a, const Polynomial& b);

[[nodiscard]] Polynomial operator-(Polynomial a);
[[nodiscard]] Polynomial operator*(const Polynomial& a, const Polynomial& b);
[[nodiscard]] Polynomial operator*(Polynomial a, const BigInteger& factor);
[[nodiscard]] Polynomial operator<<(Polynomial a, long bits);

/// The same function as a form of this degree or of its own, which may be greater.
[[nodiscard]] Polynomial raised_to(Polynomial form, std::size_t degree);

/// The form without its roots at t=0 and t=1, and without factors x + y, which are 1 for all t and
/// come from curves with more control points than they need. Empty for zero.
[[nodiscard]] Polynomial inner_polynomial(std::span<const BigInteger> form);

/// True if the polynomials certainly have no common factor.
/// \pre both are inner ones and not zero.
[[nodiscard]] bool surely_coprime(const Polynomial& a, const Polynomial& b);

/// The greatest common divisor, up to a constant factor, with coefficients about as long as those
/// of the longer polynomial. \pre as above.
[[nodiscard]] Polynomial common_divisor(Polynomial a, Polynomial b);

/// a/b times b's top coefficient, up to a power of two. The coefficients are integers: with b = c h
/// and h primitive, a/h has integer coefficients, and b's top coefficient divided by c is that of
/// h.
/// \pre b divides a, and its top coefficient is not 0.
[[nodiscard]] Polynomial scaled_quotient(Polynomial a, const Polynomial& b);

/// A polynomial with the same roots, each simple. \pre as above.
[[nodiscard]] Polynomial squarefree(const Polynomial& f);

}  // namespace touchstone::fast::exact_stage

#pragma once

/// \file
/// The exact numbers of this module, and the only conversions between them and doubles.
///
/// The types are CGAL::Exact_integer and CGAL::Exact_rational under the names of GMP's classes,
/// which CGAL takes if libgmpxx is installed; otherwise algebra/number.cpp does not compile. So no
/// other source reads CGAL's headers. The functions are thread-safe.

#include "touchstone/cxx20.hpp"

#include <gmpxx.h>

#include <string_view>

namespace touchstone::exact {

using Integer = mpz_class;
using Rational = mpq_class;

/// A closed interval of rationals, lower ≤ upper; a single number where they are equal.
struct RationalInterval {
  Rational lower;
  Rational upper;
};

/// A closed interval of doubles, lower ≤ upper.
struct DoubleInterval {
  double lower;
  double upper;

  friend bool operator==(const DoubleInterval&, const DoubleInterval&) = default;
};

/// Largest double ≤ x: −∞ below the finite range.
[[nodiscard]] double round_down(const Rational& x);

/// Smallest double ≥ x: +∞ above the finite range.
[[nodiscard]] double round_up(const Rational& x);

/// The double nearest to x, ties to the even significand; ±∞ where IEEE 754 rounds to it.
[[nodiscard]] double round_to_nearest(const Rational& x);

/// A decimal number ("-1.25E-3", any number of digits) as the rational it denotes.
/// \throws std::invalid_argument if the text is not such a number, or its exponent exceeds ±10000.
[[nodiscard]] Rational rational_from_decimal(std::string_view text);

/// 2^exponent.
[[nodiscard]] Rational power_of_two(long exponent);

}  // namespace touchstone::exact

#pragma once

/// \file
/// The exact numbers of this module, and the only conversions between them and doubles.
///
/// They are CGAL's number types, with CGAL's algebraic traits once CGAL's headers are included.
/// CGAL chooses their classes by its configuration. This project needs GMP's C++ classes, which
/// CGAL takes where libgmpxx is installed (CGAL_USE_GMPXX). The functions are thread-safe.

#include <gmpxx.h>

#include <string_view>

/// The declarations of CGAL's Exact_integer.h and Exact_rational.h. Only number.cpp includes those
/// headers, and does not compile if CGAL chooses other types: they add 3.5 s to the 0.4 s that this
/// header takes to compile, and 1.1 s in a source with a precompiled header.
// NOLINTBEGIN(readability-identifier-naming): the names are CGAL's.
namespace CGAL {
using Exact_integer = mpz_class;
using Exact_rational = mpq_class;
}  // namespace CGAL
// NOLINTEND(readability-identifier-naming)

namespace touchstone::exact {

using Integer = CGAL::Exact_integer;
using Rational = CGAL::Exact_rational;

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

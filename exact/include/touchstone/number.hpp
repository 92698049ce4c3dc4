#pragma once

/// \file
/// The exact numbers of this module, and the only conversions between them and doubles.
///
/// They are CGAL's number types. CGAL chooses their classes by its configuration. This project
/// needs GMP's C++ classes, which CGAL takes where libgmpxx is installed (CGAL_USE_GMPXX). The
/// functions are thread-safe.
///
/// CGAL's headers take 4 s to compile. The sources of this module are compiled together, and verify
/// has a precompiled header.

#include "touchstone/cxx20.hpp"

#include <CGAL/Exact_integer.h>
#include <CGAL/Exact_rational.h>
#include <gmpxx.h>

#include <string_view>
#include <type_traits>

namespace touchstone::exact {

using Integer = CGAL::Exact_integer;
using Rational = CGAL::Exact_rational;
static_assert(std::is_same_v<Integer, mpz_class> && std::is_same_v<Rational, mpq_class>,
              "CGAL must choose GMP's C++ classes: install libgmpxx and define CGAL_USE_GMPXX");

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

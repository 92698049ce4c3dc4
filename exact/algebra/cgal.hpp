#pragma once

/// \file
/// From the oracle's algebraic types to CGAL's. The numbers need no conversion: Integer and
/// Rational are CGAL's Exact_integer and Exact_rational where CGAL is configured with GMP's C++
/// classes, as it is here.

#include <CGAL/Polynomial.h>
#include <CGAL/gmpxx.h>

#include "exact/algebra/number.hpp"
#include "exact/algebra/polynomial.hpp"

namespace touchstone::exact {

/// The same polynomial, for CGAL's algebra and its algebraic kernel. Not to be shared between
/// threads.
[[nodiscard]] inline CGAL::Polynomial<Integer> to_cgal(const Polynomial& p) {
  return {p.coefficients().begin(), p.coefficients().end()};
}

}  // namespace touchstone::exact

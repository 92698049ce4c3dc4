#pragma once

/// \file
/// The floating-point numbers of `touchstone/filters/error_bounds.hpp`, rounded from the proved
/// bounds.
///
/// The user evaluates the bound by Horner's rule in the same format, with k products and k sums,
/// whose rounding must not lower it. Each operation rounds down by a factor of at least 1 − u, each
/// product also by η. With every coefficient raised by the factor (1 + 3u)^2k ≥ (1 − u)^-4k and all
/// but the last by the least subnormal (2η), the computed value is not below the proved one.
///
/// With classes (error_bound.hpp) the leading term has k separate products, in any order, and a
/// sum. Including the roundings of the magnitudes of rounded coordinates, no term has more than 3k
/// factors of 1 − u. (One more factor is reserved for a value in double_double of which code uses
/// the high part: if that is beyond the computed bound, the value is beyond the proved one.) A
/// product that underflows loses η times the later factors: that is η x^j once for each j < k among
/// the products with the coefficient, and far less than another η x^j for the products before it,
/// because the coefficient is far below 1. So for k ≥ 2 all but the last coefficients are raised by
/// 4η.

#include <span>
#include <string>
#include <vector>

#include "touchstone/derivation/rounding_model.hpp"

namespace touchstone::filters {

/// An expression in a format for which its bound ships.
struct ShippedExpression {
  ExpressionGraph graph;
  Format format;
};

/// The coefficients that ship for a bound, as exact values: each is a number of format_of_bounds().
[[nodiscard]] std::vector<mpq_class> shipped_coefficients(const DerivedBound& bound,
                                                          const Format& format);

/// The C++ text that declares a bound: `inline constexpr ErrorBound<…> NAME_FORMAT{…};` and a
/// comment.
[[nodiscard]] std::string error_bound_declaration(const ExpressionGraph& graph,
                                                  const Format& format);

/// The text of `touchstone/filters/error_bounds.hpp` for these expressions.
[[nodiscard]] std::string error_bounds_header(std::span<const ShippedExpression> expressions);

}  // namespace touchstone::filters

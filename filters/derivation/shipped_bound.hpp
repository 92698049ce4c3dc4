#pragma once

/// \file
/// From a proved bound to the floating-point numbers that ship: `filters/error_bounds.hpp`.
///
/// The user evaluates the bound by Horner's rule in the same format, k products and k sums, whose
/// own rounding must not lower it. Each operation rounds down by a factor of at most 1 − u, each
/// product by η more. With every coefficient raised by the factor (1 + 3u)^2k ≥ (1 − u)^-4k and all
/// but the last by the least subnormal (2η), the computed value is not below the proved one.
///
/// Where classes are used (error_bound.hpp) the leading term is k products of its own, in any order,
/// and the sum. With the roundings of the magnitudes, where these are of rounded coordinates, no term
/// meets more than 3k factors of 1 − u. (One more is left for a value in double_double of which code
/// sees the high part: if that is beyond the computed bound, the value is beyond the proved one.) A
/// product that underflows loses η, times what it is multiplied by afterwards: that is η x^j once for
/// each j < k among the products that the coefficient is in, and far less than another η x^j for
/// those that it, far below 1, is yet to multiply. So for k ≥ 2 all but the last are raised by 4η.

#include <span>
#include <string>
#include <vector>

#include "filters/derivation/rounding_model.hpp"

namespace touchstone::filters {

/// An expression in a format that its bound ships for.
struct ShippedExpression {
  ExpressionGraph graph;
  Format format;
};

/// The coefficients that ship for a bound, as exact values: each is a number of format_of_bounds().
[[nodiscard]] std::vector<mpq_class> shipped_coefficients(const DerivedBound& bound,
                                                          const Format& format);

/// The C++ text that declares a bound: `inline constexpr ErrorBound<…> NAME_FORMAT{…};` and a comment.
[[nodiscard]] std::string error_bound_declaration(const ExpressionGraph& graph,
                                                  const Format& format);

/// The text of `filters/error_bounds.hpp` for these expressions.
[[nodiscard]] std::string error_bounds_header(std::span<const ShippedExpression> expressions);

}  // namespace touchstone::filters

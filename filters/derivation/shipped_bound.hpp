#pragma once

/// \file
/// From a proved bound to the floating-point numbers that ship: `filters/error_bounds.hpp`.
///
/// The user evaluates the bound by Horner's rule in the same format, k products and k sums, whose
/// own rounding must not lower it. Each operation rounds down by a factor of at most 1 − u, each
/// product by η more. With every coefficient raised by the factor (1 + 3u)^2k ≥ (1 − u)^-2k and all
/// but the last by the least subnormal (2η), the computed value is not below the proved one.

#include <span>
#include <string>
#include <vector>

#include "filters/derivation/rounding_model.hpp"

namespace touchstone::filters {

/// The coefficients that ship for a bound, as exact values: each is a number of the format.
[[nodiscard]] std::vector<mpq_class> shipped_coefficients(const DerivedBound& bound,
                                                          const Format& format);

/// The C++ text that declares a bound: `inline constexpr ErrorBound<…> NAME_FORMAT{…};` and a comment.
[[nodiscard]] std::string error_bound_declaration(const ExpressionGraph& graph,
                                                  const Format& format);

/// The text of `filters/error_bounds.hpp` for these expressions, in double and float.
[[nodiscard]] std::string error_bounds_header(std::span<const ExpressionGraph> graphs);

}  // namespace touchstone::filters

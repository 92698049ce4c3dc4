#pragma once

/// \file
/// The rounding model behind the published constants ([wang2021]; docs/theory.md, section 4.10).
///
/// Coordinates and weights are at most 1 and exact. Each node has a bound on its value and one on
/// its error; with h(B) = u · 2^⌊log2 B⌋, the half ulp at magnitude B,
///
///     sum:      value A + B,   error e_A + e_B + h(A + B)
///     product:  value A B,     error A e_B + B e_A + h(A B)
///
/// Second-order terms are dropped and cancellation is ignored, so the model is neither rigorous nor
/// tight. It is here because it reproduces the published constants, to the last digit, for the
/// paper's order of operations.

#include <gmpxx.h>

#include "touchstone/derivation/expression_graph.hpp"

namespace touchstone::filters {

/// The model's bound on the expression's error, in units of u.
[[nodiscard]] mpq_class published_model_units(const ExpressionGraph& graph);

}  // namespace touchstone::filters

#pragma once

/// \file
/// INVERSION_CUBIC and INVERSION_ADDITIVE: when an element loses its volume, in floating point, as
/// line searches of injective maps and simulators of solids ask it. docs/methods.md, section 15.
///
/// Six times the volume V is a cubic in t; for a triangle in the plane twice the area, a quadratic.
///
/// - *Cubic* ([smith2015]): its coefficients, then its real zeros by the closed formulas, with
///   cosines where there are three. A leading coefficient of at most 1e-10 counts as 0. The least
///   zero in [0,1] is the time.
/// - *Additive* ([li2021], there of distances): from t, where V is positive, V stays so for V / L
///   more, L being a bound of the change of V per unit of time from the lengths of edges; so t
///   advances by that, until V is at most δ (fast::MethodOptions::tolerance).
///
/// **Promise.** None: nothing bounds the rounding. Times are estimates of the one, and bounds from
/// below of the other. Both take elements of a positive volume at t=0.
///
/// **Known defects.** Both look at numbers of absolute size: small elements have zero volume or no
/// zeros. Where V touches 0 the discriminant is a rounding error, so every other such inversion is
/// missed; in the other method V is then above δ if coordinates are large, and it goes on behind
/// the time. Far from the origin, or for flat elements, V itself is a rounding error.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solve one element. Use t_max; and tolerance (δ) and max_checks, after which the answer is yes.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, or no.
[[nodiscard]] fast::Answer inversion_cubic(Kind kind, const Query& query,
                                           const fast::MethodOptions& options);
[[nodiscard]] fast::Answer inversion_additive(Kind kind, const Query& query,
                                              const fast::MethodOptions& options);

/// The methods of those names, which promise nothing.
[[nodiscard]] std::unique_ptr<fast::Method> inversion_cubic_method();
[[nodiscard]] std::unique_ptr<fast::Method> inversion_additive_method();

}  // namespace touchstone::baselines

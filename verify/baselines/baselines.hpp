#pragma once

/// \file
/// The published methods that users compare with; more are plugins (verify/published/). The source
/// of each says its idea, its promise and its known defects; docs/methods.md lists them.

#include <memory>
#include <span>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

// Of times without a promise. All use t_max; `cubic` the tolerance, the others the distance of the
// separation, which is Euclidean; `accd` and its variant of 32 steps max_checks.
[[nodiscard]] std::unique_ptr<fast::Method> accd_method();
[[nodiscard]] std::unique_ptr<fast::Method> accd_limited_method();
[[nodiscard]] std::unique_ptr<fast::Method> cubic_method();

// For polynomial curves at distance 0, without a promise; they ignore all options but t_max.
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_method();
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_largest_deviation_method();
[[nodiscard]] std::unique_ptr<fast::Method> sampling_method();
[[nodiscard]] std::unique_ptr<fast::Method> advancement_method();

// For cells, without a promise (inversion.cpp). Both use t_max; the second the tolerance, of the
// volume, and max_checks, after which the answer is yes.
[[nodiscard]] std::unique_ptr<fast::Method> inversion_cubic_method();
[[nodiscard]] std::unique_ptr<fast::Method> inversion_additive_method();

}  // namespace touchstone::baselines

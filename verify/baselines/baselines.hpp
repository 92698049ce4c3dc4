#pragma once

/// \file
/// The published methods. The source of each says its idea, its promise and its known defects;
/// docs/methods.md lists them.

#include <memory>
#include <span>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

// Conservative: the interval root finders. Both use tolerance (δ, in units of the coordinates),
// max_checks and t_max; `irf` gives no times.
[[nodiscard]] std::unique_ptr<fast::Method> irf_method();
[[nodiscard]] std::unique_ptr<fast::Method> uirf_method();

// Of verdicts alone, without a promise; they ignore all options.
[[nodiscard]] std::unique_ptr<fast::Method> tccd_method();
[[nodiscard]] std::unique_ptr<fast::Method> rp_method();
[[nodiscard]] std::unique_ptr<fast::Method> rrp_method();
[[nodiscard]] std::unique_ptr<fast::Method> bsc_method();

// Of times without a promise. All use t_max; `cubic` the tolerance, the others the distance of the
// separation, which is Euclidean; `accd` and its variant of 32 steps max_checks.
[[nodiscard]] std::unique_ptr<fast::Method> fprf_method();
[[nodiscard]] std::unique_ptr<fast::Method> msrf_method();
[[nodiscard]] std::unique_ptr<fast::Method> accd_method();
[[nodiscard]] std::unique_ptr<fast::Method> accd_limited_method();
[[nodiscard]] std::unique_ptr<fast::Method> cubic_method();

// For polynomial curves at distance 0, without a promise; they ignore all options but t_max.
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_method();
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_largest_deviation_method();
[[nodiscard]] std::unique_ptr<fast::Method> sampling_method();
[[nodiscard]] std::unique_ptr<fast::Method> advancement_method();

// For elements, without a promise (inversion.cpp). Both use t_max; the second the tolerance, of the
// volume, and max_checks, after which the answer is yes.
[[nodiscard]] std::unique_ptr<fast::Method> inversion_cubic_method();
[[nodiscard]] std::unique_ptr<fast::Method> inversion_additive_method();

/// RP's verdict. \pre all coordinates are finite, and the rounding is to nearest.
/// \throws std::overflow_error if the segment does not fit into doubles, to be treated as a
/// collision.
[[nodiscard]] bool rp_collides(Kind kind, const Query& query);

/// BSC's verdict. \pre as rp_collides.
/// \throws std::domain_error where the cubic has an inflection, as in the published code, to be
/// treated as a collision.
[[nodiscard]] bool bsc_collides(Kind kind, const Query& query);

/// MSRF's quick tests before the polynomial of degree 6 is solved: true if it has no zero in [0,1]
/// by its seven coefficients, the constant first. Sometimes wrong (msrf.cpp, known defects).
[[nodiscard]] bool msrf_rules_out_zeros(std::span<const double, 7> coefficients);

}  // namespace touchstone::baselines

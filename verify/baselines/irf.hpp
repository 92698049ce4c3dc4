#pragma once

/// \file
/// IRF: the multivariate interval root finder ([snyder1992]; as compared by [wang2021]).
/// docs/methods.md, section 3.
///
/// F(t,u,v) is evaluated in intervals over boxes of parameters, first the points at t, then their
/// combination. A box for which a component of F excludes 0 holds no root and is dropped; the
/// others are bisected, t, u and v in turn, depth first (interval_search.hpp). A box narrower than
/// δ divided by the greatest displacement in t, and by the lengths of the edges in u and v, is a
/// collision.
///
/// **Promise.** Conservative: rounding is outward and no box that holds a root is dropped.
///
/// **Known defects.**
///   - The box that ends the search is small in its parameters and need not hold a root, nor be
///     within δ in F: near misses of δ's order are false positives. (A vertex that passes the side
///     u + v = 1 of a face, δ/16 away.)
///   - With rotating dimensions that box need not be the earliest: its time bounds nothing, so
///     answers have none.
///   - Only fast::MethodOptions::max_checks bounds the work: after that number of boxes the answer
///     is undecided, with max_checks as `checks`. Motion in a plane takes longest if the primitives
///     barely avoid a contact.
///   - It does not support a minimum separation: queries that only come within one are false
///     negatives.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solves one query. Uses tolerance (δ, in units of the coordinates), max_checks and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes or no, or undecided once max_checks are spent; never times.
[[nodiscard]] fast::Answer irf(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The method `irf`, which promises to be conservative.
[[nodiscard]] std::unique_ptr<fast::Method> irf_method();

}  // namespace touchstone::baselines

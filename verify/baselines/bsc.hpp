#pragma once

/// \file
/// BSC: Bernstein sign classification [tang2014], as patched for the comparison of [wang2021]
/// (docs/methods.md, sections 6 and 8).
///
/// **Algorithm.** The coplanarity cubic is classified by its Bernstein coefficients: monotone, one
/// extremum, or an inflection; its roots are counted, and at each the signs of three inside quartics
/// are found from linear forms (bernstein.hpp). First in intervals; if they do not say yes, again in
/// exact numbers. Before that, a quick no by absolute thresholds in doubles.
///
/// **What it gives.** A verdict. No time of impact (a yes does not look at t_max), no separation.
///
/// **Known to be wrong**, all of it by design or by the published code, and reproduced:
///   - *False positives*: a cubic with an inflection throws, and the published harness makes of
///     whatever is thrown a collision. That is more than half of all random hits, and the printed
///     query with an inflection, which misses. Where k_0 = 0, J vanishes and rejects nothing.
///   - *False negatives*: motion in a common plane makes all coefficients 0. Equal signs, so
///     monotone; equal signs at both ends, so no root: no collision. Every exactly coplanar contact
///     is missed: the printed coplanar query, two edges at rest that cross.
///   - *False negatives by scale*: the quick no asks for values above 100·2^-52 and is safe for
///     coordinates about 1; with large coordinates rounding exceeds it.
///   - A linear form that vanishes at t = 0 and ends positive is evaluated with the wrong sign (the
///     published flip looks whether the first coefficient is negative). At such a root of its own the
///     answer may be wrong either way.
///
/// The published code throws past the restoring of the rounding mode, which then stays upward for
/// the rest of the process, where its arithmetic is not exact. Here it is restored.
///
/// It promises nothing.

#include <memory>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::baselines {

/// BSC's verdict. \pre all coordinates are finite, and the rounding is to nearest.
/// \throws std::domain_error where the cubic has an inflection, as the published code throws: to be
/// taken as a collision.
[[nodiscard]] bool bsc_collides(Kind kind, const Query& query);

/// As a method: its name is `bsc`. It ignores all options.
[[nodiscard]] std::unique_ptr<fast::Method> bsc_method();

}  // namespace touchstone::baselines

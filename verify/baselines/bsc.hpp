#pragma once

/// \file
/// BSC: Bernstein sign classification [tang2014], as patched for the comparison of [wang2021]
/// (docs/methods.md, sections 6 and 8).
///
/// **Algorithm.** The coplanarity cubic is classified by its Bernstein coefficients: monotone, one
/// extremum, or an inflection; its roots are counted, and at each the signs of three inside
/// quartics are found from linear forms (bernstein.hpp). First in intervals; if they do not say
/// yes, again in exact numbers. Before that, a quick no by absolute thresholds in doubles.
///
/// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
///
/// **Known defects**, from the design or the published code, and reproduced:
///   - *False positives*: a cubic with an inflection throws, and the published harness treats every
///     exception as a collision. This is the answer for more than half of all random collisions,
///     and for the printed query with an inflection, which does not collide. Where k_0 = 0, J
///     vanishes and rejects nothing.
///   - *False negatives*: motion in a common plane makes all coefficients 0. Equal signs are read
///     as monotone, and equal signs at both ends as no root: no collision. Every exactly coplanar
///     contact is missed: the printed coplanar query, two edges at rest that cross.
///   - *False negatives by scale*: the quick no requires values above 100·2^-52 and is safe for
///     coordinates of about 1; with large coordinates rounding exceeds it.
///   - A linear form that vanishes at t = 0 and ends positive is evaluated with the wrong sign (the
///     published flip tests whether the first coefficient is negative). At such a root the answer
///     may be wrong either way.
///
/// An exception of the published code skips the restoring of the rounding mode, which then stays
/// upward for the rest of the process and invalidates its exact arithmetic. Here the mode is
/// restored.
///
/// **Promise.** None.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// BSC's verdict. \pre all coordinates are finite, and the rounding is to nearest.
/// \throws std::domain_error where the cubic has an inflection, as in the published code, to be
/// treated as a collision.
[[nodiscard]] bool bsc_collides(Kind kind, const Query& query);

/// The method `bsc`. It ignores all options.
[[nodiscard]] std::unique_ptr<fast::Method> bsc_method();

}  // namespace touchstone::baselines

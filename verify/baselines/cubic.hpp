#pragma once

/// \file
/// CUBIC: the zeros of the coplanarity cubic with a tolerance, as simulators of cloth run it
/// ([provot1997]; the public ARCSim and El Topo). docs/methods.md, section 13.
///
/// det = r·(p×q), a cubic in t, is 0 at a contact. Its zeros are computed in double precision
/// (rpoly.hpp). *Filtered*: a zero whose imaginary part and distance from [0,1] are at most 1e-6
/// counts, moved to the nearest time of [0,1]; t=0 and t=1 are added. The earliest of these times
/// at which the primitives are within δ is the impact. δ is fast::MethodOptions::tolerance.
///
/// **Promise.** None: nothing bounds the rounding. Times are estimates.
///
/// **Known defects.**
///   - δ and the filter of zeros are absolute: a pass within δ is a false positive; where
///     coordinates are large, the primitives are farther apart than δ at the rounded zero, and the
///     contact is a false negative.
///   - Where all points move in one plane the cubic is 0 throughout, or consists of rounding
///   errors:
///     contacts between t=0 and t=1 are false negatives.
///   - A triple zero is computed as a cluster with a third of the digits.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// Solves one query. Uses tolerance (δ) and t_max.
/// \pre finite coordinates, valid options, rounding to nearest (method_support.hpp).
/// \returns yes with toi_lower, an estimate; or no.
[[nodiscard]] fast::Answer cubic(Kind kind, const Query& query, const fast::MethodOptions& options);

/// The method `cubic`, which promises nothing.
[[nodiscard]] std::unique_ptr<fast::Method> cubic_method();

}  // namespace touchstone::baselines

#pragma once

/// \file
/// The certified solver for points on Bézier curves, polynomial or rational: exact verdicts and
/// proved enclosures of the time of impact, as for straight lines (touchstone/certified.hpp).
///
/// Stages (docs/theory.md, section 6.15), on the control points of the corners:
/// - *axis*, *direction*: a direction that keeps all control points of all corners on one side
///   separates at all times, since a curve is in the hull of its control points;
/// - *bisection*: the same on pieces of time, in ascending order, and a proof of contact on a
/// piece;
/// - *exact*: integers of any size.
///
/// The exact stage ends for all finite weights. Lines, as curves of degree 1 without different
/// weights, it decides as touchstone/certified.hpp does. Of others it took, without a distance, at
/// most so many milliseconds (hundreds of random queries, all points with weights of their own, one
/// core, 27 November 2026); with one it takes up to seconds, more for such weights:
///
/// | degree                        | 1   | 2   | 3   | 8     |
/// |-------------------------------|-----|-----|-----|-------|
/// | weights from 0.1 to 10        | 0.3 | 0.8 | 2.3 | 75    |
/// | weights of all finite doubles | 6.5 | 62  | 220 | 2,800 |
///
/// Unless an axis separates, it decides
/// - with a separation, curves whose points do not share the weights of their primitive,
/// - curves of a degree above 4 with different weights, and
/// - weights that are not between 2^-30 and 2^30.

#include <span>

#include "touchstone/certified.hpp"
#include "touchstone/curved_query.hpp"

namespace touchstone::fast {

/// Decides query i in results[i]. The verdict is `error` if a coordinate is not finite or a weight
/// is not positive and finite. Thread-safe; the caller's floating-point state has no effect.
/// \throws std::invalid_argument for options out of range, a degree above greatest_degree, numbers
/// that are no whole queries, or spans of different lengths.
void solve(Kind kind, const CurvedQueries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options = {});

}  // namespace touchstone::fast

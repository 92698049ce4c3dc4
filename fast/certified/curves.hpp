#pragma once

/// \file
/// A block of queries on curves through the stages in floating point (docs/theory.md, section
/// 6.15), which look at the control points of the corners:
///
///     axis, direction, bisection    fast/certified/curves/stages.hpp
///
/// Unless an axis separates, these go to the exact stage at once:
/// - with a separation, curves whose points do not share the weights of their primitive,
/// - curves of a degree above 4 with different weights, and
/// - weights that are not between 2^-30 and 2^30.
///
/// The exact stage ends for all finite weights. It took, without a distance, at most so many
/// milliseconds (hundreds of random queries, all points with weights of their own, one core, 27
/// November 2026); with one it takes up to seconds, more for such weights:
///
/// | degree                        | 1   | 2   | 3   | 8     |
/// |-------------------------------|-----|-----|-----|-------|
/// | weights from 0.1 to 10        | 0.3 | 0.8 | 2.3 | 75    |
/// | weights of all finite doubles | 6.5 | 62  | 220 | 2,800 |

#include "fast/certified/kernel.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// Runs the kernel on at most kernel_block queries. The output is this thread's, until the next
/// call. \pre strict floating point
[[nodiscard]] const KernelOutput& search_curves(const Queries& queries,
                                                const CertifiedOptions& options,
                                                const CertifiedKernel& kernel);

}  // namespace touchstone::fast

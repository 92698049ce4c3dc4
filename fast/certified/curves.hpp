#pragma once

/// \file
/// The floating-point stages for a block of queries on curves (docs/theory.md, section 6.15). They
/// use the control points of the corners:
///
///     axis, direction, bisection    fast/certified/curves/stages.hpp
///
/// Unless an axis separates, these go to the exact stage at once:
/// - with a separation, curves whose points do not share the weights of their primitive,
/// - curves of a degree above 4 with different weights, and
/// - weights that are not between 2^-30 and 2^30.
///
/// The exact stage ends for all finite weights. If each point has its own weights, and coordinates
/// are up to about 1, it took at most these milliseconds (14 to 200 random queries of each kind,
/// one core, 27 November 2026). With numbers of thousands of bits, common divisors take most of the
/// time.
///
/// | degree                                       | 1   | 2   | 3     | 8            |
/// |----------------------------------------------|-----|-----|-------|--------------|
/// | weights from 0.1 to 10                       | 0.2 | 0.5 | 1.1   | 7.1          |
/// | weights from 0.1 to 10, distance 1e-3        | 1.0 | 2.9 | 6.3   | 100          |
/// | weights of all finite doubles                | 4.2 | 24  | 70    | 1,300        |
/// | weights of all finite doubles, distance 1e-3 | 72  | 480 | 2,300 | not measured |

#include "fast/certified/block.hpp"
#include "fast/certified/kernel.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// Runs the kernel on at most kernel_block queries, for contacts up to t_limit. The output is this
/// thread's, until the next call. \pre strict floating point
[[nodiscard]] const KernelOutput& search_curves(const Queries& queries, double t_limit,
                                                const CertifiedOptions& options,
                                                const CertifiedKernel& kernel);

/// Decides at most kernel_block queries, as decide_block does. \pre as above
template <class Report>
void decide_curves(const Queries& queries, double t_limit, const CertifiedOptions& options,
                   const CertifiedKernel& kernel, const Report& report) {
  report_contacts(
      search_curves(queries, t_limit, options, kernel), options,
      [&](std::size_t index) { return decided_exactly(queries, index, options); }, report);
}

}  // namespace touchstone::fast

#pragma once

/// \file
/// A fast test for many pairs at rest, on lanes: which of them may be within a distance.
///
/// Primitives at rest are within a distance iff a step without motion has contact at that
/// separation. So the floating-point stages of the certified solver (fast/certified/kernel.hpp)
/// exclude pairs.

#include <cstdint>
#include <span>
#include <vector>

#include "fast/kernels.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// The indices of the queries that may be within the distance at t=0: all that are, and possibly
/// others. Replaces their ends by their starts.
/// \pre Strict floating point; all coordinates are finite; at most kernel_block queries.
[[nodiscard]] std::vector<std::uint32_t> perhaps_within(
    Kind kind, std::span<Query> queries, const Separation& separation,
    const CertifiedKernel& kernel = certified_kernel({}));

/// The same for some of a step's candidates.
[[nodiscard]] std::vector<std::uint32_t> perhaps_within(const Step& step,
                                                        const StepCandidates& candidates,
                                                        const Separation& separation);

}  // namespace touchstone::fast

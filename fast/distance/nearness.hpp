#pragma once

/// \file
/// Which of some pairs at rest are near: a quick answer for many, on lanes.
///
/// Primitives at rest are within a distance iff a step without motion has contact at that separation. So
/// the certified solver's stages in floating point (fast/certified/kernel.hpp) tell which are not.

#include <cstdint>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// The places of those queries that may be within the distance at t=0: all that are, and perhaps some
/// others. Replaces their ends by their starts. Under strict floating point.
/// \pre All coordinates are finite; at most kernel_block queries.
/// \param kernel nullptr: the best one.
[[nodiscard]] std::vector<std::uint32_t> perhaps_within(Kind kind, std::span<Query> queries,
                                                        const Separation& separation,
                                                        const CertifiedKernel* kernel = nullptr);

/// The same of some of a step's candidates, by the step's kernel.
[[nodiscard]] std::vector<std::uint32_t> perhaps_within(const Step& step,
                                                        const StepCandidates& candidates,
                                                        const Separation& separation);

}  // namespace touchstone::fast

#pragma once

/// \file
/// The maps of stability: for each hardness a grid with a cell for each level, by its worst
/// fault and by its numbers.

#include <span>
#include <vector>

#include "verify/report/figure.hpp"
#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

/// The maps of the marks that have something to show. \pre the slots have all methods
[[nodiscard]] std::vector<Figure> stability_figures(std::span<const StabilityMark> marks,
                                                    const MethodSlots& slots);

}  // namespace touchstone::verify::report

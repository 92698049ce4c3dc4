#pragma once

/// \file
/// The figures of a report. page.js draws them; each has its numbers as a table too.

#include <vector>

#include "verify/report/figure.hpp"
#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

/// All figures that the measurements have data for.
[[nodiscard]] std::vector<Figure> figures_of(const Measurements& measurements);

}  // namespace touchstone::verify::report

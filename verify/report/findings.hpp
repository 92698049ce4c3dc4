#pragma once

/// \file
/// The findings of a report in a few sentences: the page opens with them.

#include <string>
#include <vector>

#include "verify/report/figures.hpp"
#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

/// A sentence each on the queries, on what is missed and what is right everywhere, on time, on the
/// Pareto fronts of the figures, and on broken promises. Of methods in the experiment "field", but
/// for the promises, which are those of all experiments. Empty without measurements.
[[nodiscard]] std::vector<std::string> findings_of(const Measurements& measurements,
                                                   const std::vector<Figure>& figures);

}  // namespace touchstone::verify::report

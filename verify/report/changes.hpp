#pragma once

/// \file
/// What has changed since an earlier report.

#include "verify/report/measurement.hpp"
#include "verify/report/tables.hpp"

namespace touchstone::verify::report {

/// A time counts as changed if it is more than this factor longer or shorter, as a multiple of the
/// certified solver's: machines differ, and are noisy.
inline constexpr double changed_time = 1.25;

/// A row for each method, group and kind of the experiment "field" whose false negatives, false
/// positives, late times of impact or time have changed ("2 of 100 → 0 of 100"; "=" where nothing
/// has), or that is new or gone. A group whose queries are others than before is said to be so.
[[nodiscard]] Table changes_between(const Measurements& before, const Measurements& after);

}  // namespace touchstone::verify::report

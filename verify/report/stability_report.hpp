#pragma once

/// \file
/// A map of stability for people (tables), for machines (JSON) and for the page (page.hpp).

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "verify/report/measurement.hpp"
#include "verify/stability/stability.hpp"

namespace touchstone::verify::report {

/// A table for each method: a line for each hardness and kind, with a character for each level, and
/// one for errors and hangs, which may stand behind something worse (what they mean is said below
/// the last table), the sums of all levels, the mean time, the mean number of checks where the
/// method counts them, and the error of the time of impact: how far toi_lower is from the exact
/// one, in units of the motion's duration. Above it whether the method keeps its promise. Queries
/// on which certified solver and oracle differ are named at the end.
[[nodiscard]] std::string to_text(const stability::StabilityResult& result);

/// `seed`, `count` (queries a cell), `separation` (null, or `min_separation` and `norm`),
/// `interrupted`, `disagreements` (queries on which certified solver and oracle differ);
/// `hardnesses`, a list of `name`, `measure`, `reason` and `levels` (as in cells); `methods`, a
/// list of `name`, `promise`, `keeps_promise` and `cells`.
///
/// A cell has `hardness`, `level` (the power of two, number of digits or percentage), `kind`,
/// `queries`, `collisions`, the fields of a judgement (judgement_report.hpp), `beyond_tolerance`,
/// the rates `false_negative_rate` (of the collisions) and `false_positive_rate` (of the others),
/// `worst` (null, or the name of the worst fault) with its `worst_rate`, `ns_per_query` and
/// `checks_per_query` (null where unknown).
[[nodiscard]] nlohmann::json to_json(const stability::StabilityResult& result);

/// "certified (exact): keeps its promise", "tccd: promises nothing; answers worse than false
/// positives".
[[nodiscard]] std::string promise_text(const jobs::MethodResult& method);

/// The cells as a report holds them, method by method within a cell.
[[nodiscard]] std::vector<StabilityMark> marks_of(const stability::StabilityResult& result);

/// A table of texts (`title`, `columns`, `rows`), a row a method, a column a hardness: the worst
/// that happened at any level, and how often.
[[nodiscard]] nlohmann::json overview_of(const stability::StabilityResult& result);

}  // namespace touchstone::verify::report

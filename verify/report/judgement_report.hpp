#pragma once

/// \file
/// Faults of a method's answers in words, in tables and as JSON: the same for every command
/// that judges.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "verify/io/text_table.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::report {

// ---- Text ---------------------------------------------------------------------------------------

/// The columns of false negatives, false positives, late and early times of impact, undecided
/// answers and errors.
[[nodiscard]] std::vector<io::TextColumn> fault_columns();
/// Their cells.
[[nodiscard]] io::TextRow fault_cells(const judge::Judgement& judgement);

/// True if a yes is beyond its tolerance.
[[nodiscard]] bool claims_too_much(const judge::Judgement& judgement);
/// The column of these answers, for tables that have it only if there are some.
[[nodiscard]] io::TextColumn tolerance_column();
/// Its cell.
[[nodiscard]] std::string tolerance_cell(const judge::Judgement& judgement);

/// The columns of the errors of times of impact: median, 99th percentile, maximum.
[[nodiscard]] std::vector<io::TextColumn> toi_error_columns();
/// Their cells.
[[nodiscard]] io::TextRow toi_error_cells(const judge::ToiErrors& errors);

/// Exceptions from reading, a line each: queries in error, and rounded coordinates. Empty if all
/// was.
[[nodiscard]] std::string reading_text(std::uint64_t skipped, std::uint64_t rounded);

// ---- JSON ---------------------------------------------------------------------------------------

/// `false_negatives`, `false_positives` (undecided answers among them), `late_toi`,
/// `early_toi_upper`, `beyond_tolerance`, `undecided`, `errors`, `outside` and `left_out` (queries
/// that were not asked: Judgement), `late` (`count`, `beyond`, the
/// numbers of those later by more than 1e-12, 1e-9, 1e-6 and 1e-3 of the step, `greatest` in units
/// of the step, and `greatest_ulps`), and `toi_error`: null where no time of impact was given, else
/// `count`, `p50`, `p90`, `p99`, `max` and `histogram` (judge::ToiErrors) of the distance from
/// toi_lower to the exact time of impact, quantiles to 1.6%.
[[nodiscard]] nlohmann::json to_json(const judge::Judgement& judgement);

}  // namespace touchstone::verify::report

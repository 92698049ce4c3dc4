#pragma once

/// \file
/// The rows of a benchmark for people (tables) and for machines (JSON).

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "verify/jobs/bench.hpp"
#include "verify/jobs/step_bench.hpp"

namespace touchstone::verify::report {

/// A table: a line for each row with what its settings are, if they differ from others' of the
/// table, its time a query in nanoseconds, the same as a multiple of the certified solver's and of
/// the memory pass, the numbers of queries that were timed and judged, the collisions among these,
/// the counts of the judge and the errors of the times of impact. Below it, who
/// broke a promise.
/// \pre the rows are of one source and kind, at least one
[[nodiscard]] std::string to_text(std::span<const jobs::BenchRow> rows);

/// The times of a step.
[[nodiscard]] std::string to_text(const jobs::StepResult& step);

/// The meaning of the columns.
[[nodiscard]] std::string bench_legend(const jobs::BenchOptions& options, bool has_step);

/// `source`, `kind`, `level` (null: none), `method`, `promise`, `tolerance`, `max_checks`,
/// `min_separation` and `norm`; `queries` (of the source), `timed` (of these), `judged` (of these),
/// `collisions` and the counts of judgement_report.hpp (of those judged), `at_limit`,
/// `keeps_promise`; `ns_per_query`, `certified_ns_per_query`, `pass_ns_per_query` (medians of
/// turns; null if there was none), `single` (null, or `mean_ns`, `p50_ns`, `p99_ns` of one call a
/// query); `interrupted`.
[[nodiscard]] nlohmann::json to_json(const jobs::BenchRow& row);

/// `step` (its name), `vertices`, `edges`, `faces`, `vertex_face` and `edge_edge` (`candidates` and
/// `collisions` each), `earliest` (null, or `toi_lower` and `toi_upper`), `earliest_agrees`,
/// `interrupted`, `min_separation`, `norm`, `memory_pass_s` (the time of reading the mesh once),
/// and `times`, a list of `threads` and of seconds: for each of jobs::step_parts `PART_s` is wall
/// time, `PART_processor_s` processor time of all threads together.
[[nodiscard]] nlohmann::json to_json(const jobs::StepResult& step);

}  // namespace touchstone::verify::report

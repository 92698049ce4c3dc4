#pragma once

/// \file
/// The results of a benchmark for people (tables) and for machines (JSON).

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "verify/jobs/bench.hpp"
#include "verify/jobs/step_bench.hpp"

namespace touchstone::verify::report {

/// The results of a run of `touchstone bench`.
struct BenchReport {
  jobs::BenchOptions options;
  std::vector<jobs::BenchResult> groups;
  /// The result of a whole step, if one was measured.
  std::optional<jobs::StepResult> step = std::nullopt;
};

/// True if a solver broke its promise on judged queries, or the earliest impact of a step
/// contradicts its collisions.
[[nodiscard]] bool has_wrong_answers(const BenchReport& report);

/// A table for each group: a line for each solver with its time a query in nanoseconds, the same as
/// a multiple of the memory pass, the times of single queries, the numbers of queries that were
/// timed and judged, the counts of the judge and the errors of the times of impact; below it the
/// share of the queries that each of its stages ended. Then the answers that broke a promise, the
/// first twenty of a fault and group. Then the step. Last, the meaning of the columns.
[[nodiscard]] std::string to_text(const BenchReport& report);

/// `repetitions`, `seconds` and `judge` as in BenchOptions; `groups`, a list of `name`, `kind`,
/// `queries`, `judged`, `collisions` (of those judged), `interrupted`, `memory_pass` and `methods`;
/// `step`, null if none was measured.
///
/// Times are objects of `ns_per_query` (the median), `min_ns_per_query` and `repetitions`, the
/// first two null if there was no repetition. Each of `methods` has `name`, `promise`, `queries`
/// (timed), `time`, `passes` (median time by that of the memory pass, or null), `single` (null, or
/// `queries`, `mean_ns`, `p50_ns`, `p99_ns`, `max_ns`), `stages` (null, or the number of queries by
/// the stage's name), `judged`, the fields of a judgement (judgement_report.hpp), `broke_promise`,
/// and `wrong_answers`, a list of `source`, `index`, `fault`, `answer` and `truth`.
///
/// Groups and step have their separation as `separation`, an object of `min_separation` and `norm`.
///
/// `step` has `name`, `vertices`, `edges`, `faces`, `vertex_face` and `edge_edge` (`candidates` and
/// `collisions` each), `earliest` (null, or `toi_lower` and `toi_upper`), `earliest_agrees`,
/// `interrupted`, `memory_pass_s` (the time of reading the mesh once), `memory` (`peak_bytes`,
/// `page_faults` and `page_faults_of_next`: jobs::StepMemory), and `times`, a list of `threads` and
/// of seconds: `trees_s`, `candidates_s`, `collisions_s`, `earliest_s`, `next_s`,
/// `free_step_size_s`, `limit_of_scene_s` and `limit_of_pairs_s` (jobs::StepTimes) are wall time,
/// `trees_processor_s` and so on processor time of all threads together.
[[nodiscard]] nlohmann::json to_json(const BenchReport& report);

}  // namespace touchstone::verify::report

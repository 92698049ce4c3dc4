#pragma once

/// \file
/// The map of stability: certify (jobs/certify.hpp) on the hard queries (generate/hardness.hpp) of
/// every sort, level and kind, one cell of the map each; for people (tables), for machines (JSON)
/// and for the page (report_page.hpp).
///
/// The truth of a query comes twice: from the certified solver as its label, and from the oracle,
/// which judges; where they differ, that is counted as a wrong label. All but the times is a
/// function of options and methods, the same for any number of threads.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/generate/hardness.hpp"
#include "verify/jobs/certify.hpp"
#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

struct StabilityOptions {
  std::vector<const generate::Hardness*> hardnesses = {};  ///< not null
  std::uint64_t seed = 0;
  /// Queries a cell, half of them collisions.
  std::uint64_t count = 200;
  /// Wall-clock time, shared over cells and solvers (jobs::Budget); 0: no limit.
  double seconds = 0.0;
  /// The solvers, and how they are judged. The separation is that where the level does not scale
  /// it (generate::separation_at); the progress is that of all cells; deadlines are set here.
  jobs::CertifyOptions certify = {};
};

/// The judgement on the queries of one sort.
struct StabilityCell {
  generate::HardSort sort;
  jobs::CertifyResult judged;
};

struct StabilityResult {
  Separation separation = {};
  std::uint64_t seed = 0;
  std::uint64_t count = 0;
  /// Methods with what they were held to, judged on all cells.
  jobs::CertifyResult total;
  /// By hardness, then kind, then level, each in its order.
  std::vector<StabilityCell> cells;
  std::size_t unjudged_cells = 0;  ///< of those asked for, for lack of time or a stop
};

/// \throws std::invalid_argument if there are no hard queries about the separation.
[[nodiscard]] StabilityResult measure_stability(const StabilityOptions& options);

/// The rate of a fault of method number `method` as a fraction of the queries where it is possible:
/// of those that collide (false negatives, times of impact), of those that do not (false positives,
/// nearness), or of all (errors); 0 if there was none.
[[nodiscard]] double rate_of(judge::Fault fault, const jobs::CertifyResult& judged,
                             std::size_t method);

/// A table for each method: a line for each hardness and kind, with a character for each level, and
/// one for errors and hangs, which may stand behind something worse (what they mean is said below
/// the last table), the sums of all levels, the mean time, the mean number of checks where the
/// method counts them, and the error of the time of impact: how far toi_lower is from the exact
/// one, in units of the motion's duration. Above it whether the method keeps its promise. Queries
/// on which certified solver and oracle differ are named at the end.
[[nodiscard]] std::string to_text(const StabilityResult& result);

/// `seed`, `count` (queries a cell), `separation` (`min_separation` and `norm`),
/// `interrupted`, `disagreements` (queries on which certified solver and oracle differ);
/// `hardnesses`, a list of `name`, `measure`, `reason` and `levels` (as in cells); `methods`, a
/// list of `name`, `promise`, `keeps_promise` and `cells`.
///
/// A cell has `hardness`, `level` (the power of two, number of digits or percentage), `kind`,
/// `queries`, `collisions`, the fields of a judgement (judgement_report.hpp), `beyond_tolerance`,
/// the rates `false_negative_rate` (of the collisions) and `false_positive_rate` (of the others),
/// `worst` (null, or the name of the worst fault) with its `worst_rate`, `ns_per_query` and
/// `checks_per_query` (null where unknown).
[[nodiscard]] nlohmann::json to_json(const StabilityResult& result);

/// "certified (exact): keeps its promise", "tccd: promises nothing; answers worse than false
/// positives".
[[nodiscard]] std::string promise_text(const jobs::MethodResult& method);

/// The cells as a report holds them, method by method within a cell.
[[nodiscard]] std::vector<StabilityMark> marks_of(const StabilityResult& result);

/// A table of texts (`title`, `columns`, `rows`), a row a method, a column a hardness: the worst
/// that happened at any level, and how often.
[[nodiscard]] nlohmann::json overview_of(const StabilityResult& result);

}  // namespace touchstone::verify::report

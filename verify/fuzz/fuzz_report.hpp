#pragma once

/// \file
/// The report of the fuzzer: as text for a person, as JSON for a program.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/fuzz/reproduce.hpp"

namespace touchstone::verify::fuzz {

/// A run and what was asked for.
struct FuzzReport {
  SolverCall solver;  ///< that is searched for wrong answers
  std::uint64_t seed = 0;
  double seconds = 0.0;                 ///< asked for; 0: no limit
  std::uint64_t queries = 0;            ///< asked for; 0: no limit
  std::vector<judge::Fault> only = {};  ///< sought; empty: all
  /// Of the curves, as they were asked for; empty: straight lines alone.
  std::vector<std::string> degrees = {};
  FuzzResult result;
};

/// Where the finding's query is wrong when it is multiplied by powers of two: "wrong while the
/// greatest coordinate is below 2^-3", "wrong at any scale from 2^-16 to 2^40".
[[nodiscard]] std::string scale_text(const Finding& finding, const SolverCall& asked);

/// "false_negative of METHOD, edge-edge: no, but they collide", for when a group is found.
[[nodiscard]] std::string to_line(const Finding& finding);

/// The numbers of a run, why it ended where not all is done that was asked for, a table of the
/// groups of findings, and of each group the plainest finding in about ten lines: what is wrong,
/// the truth, at what scales, and the points.
[[nodiscard]] std::string to_text(const FuzzReport& report);

/// An object of `what`, `kind`, `separation` (`min_separation`, `norm`), `method`, `generator`,
/// `seconds`, `queries`, `shrinking` ("not tried", "complete", "cut short" or "not reproduced"); of
/// the simplest query `coordinates` (24 numbers in hexadecimal, as text; on curves instead
/// `degree`, `rational`, `control`, for each control point a list of four points, of rational
/// curves `weights` likewise, and all as numbers in one list `numbers`), `answer` (`verdict`,
/// `toi_lower`, `toi_upper` and `tolerance`, as number_to_json of io/json.hpp writes them),
/// `collides`, `truth`, `detail` and `certificate` (a stream that touchstone-check takes; null if
/// there is none), and the same in `original`, an object, of the query as it was found; `solver`
/// (see below) and `command`, which asks again; `group`, its number in `groups` from 0, and
/// `wrong_until`, the ends of its scales, `below` and `above` (binary exponents of the greatest
/// coordinate; null where none is known).
[[nodiscard]] nlohmann::json to_json(const Finding& finding, const SolverCall& asked);

/// An object of `solver` (`method`, `plugin` or null, `promise`, `tolerance`, `max_checks`,
/// `min_separation`, `plugin` or null, `promise`, `terms` (as options of the command line),,
/// `memory_limit` in bytes, `allow_processes`), `method`, `promise`, `seed`, `separation`, `asked`
/// (`seconds` and `queries`, null without a limit, and `only`, a list of kinds, empty for all; on
/// curves `degrees`), `ended_by` ("time", "queries", "findings" or "interrupt"), `queries`,
/// `unjudged`, `unanswered`, `outside` and `left_out` (not asked), `images`, `collisions`,
/// `judged_by_oracle`, `seconds`, `method_seconds`, `shrink_seconds`, `other_seconds`,
/// `queries_per_second`, `judged_per_second`, `all_findings`, `other_findings`, `unplaced_crashes`,
/// `interrupted`, `generators` (a list of `name`, `queries`, `collisions`, `coverage_keys`,
/// `findings`), `findings`, a list as above, and `groups`, a list of `what`, `method`, `count`,
/// `best` (a number in `findings`), `scale`, `kind`, `shape` and `time` (signature.hpp, in words;
/// `kind` null where it does not matter).
[[nodiscard]] nlohmann::json to_json(const FuzzReport& report);

}  // namespace touchstone::verify::fuzz

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
  double seconds = 0.0;                ///< asked for; 0: no limit
  std::uint64_t queries = 0;           ///< asked for; 0: no limit
  std::vector<FindingKind> only = {};  ///< sought; empty: all
  FuzzResult result;
};

/// "false_negative of METHOD, vertex-face (contact_on_grid, after 1.5 s and 3200 queries)", then of the
/// simplest query what is wrong, the truth and the points, and of the original one too if that is
/// another; then the simplest one as a command that asks again, and as a C++ test.
[[nodiscard]] std::string to_text(const Finding& finding, const SolverCall& asked);

/// The numbers of a run: queries a second with and without the method's time, how many the oracle
/// judged, a line for each generator, why it ended where not all is done that was asked for, and last
/// how many findings there are.
[[nodiscard]] std::string to_text(const FuzzReport& report);

/// An object of `what`, `kind`, `separation` (`min_separation`, `norm`), `method`, `generator`,
/// `seconds`, `queries`, `shrinking` ("not tried", "complete", "cut short" or "not reproduced"); of the
/// simplest query `coordinates` (24 numbers in hexadecimal, as text), `answer` (`verdict`,
/// `toi_lower`, `toi_upper` and `tolerance`, as number_to_json of io/json.hpp writes them), `collides`, `truth`, `detail` and
/// `certificate` (a stream that touchstone-check takes; null if there is none), and the same in
/// `original`, an object, of the query as it was found; `solver` (see below) and `command`, which asks
/// again.
[[nodiscard]] nlohmann::json to_json(const Finding& finding, const SolverCall& asked);

/// An object of `solver` (`method`, `plugin` or null, `promise`, `tolerance`, `max_checks`,
/// `min_separation`, `norm`, `t_max`, `query_limit`, `memory_limit` in bytes, `allow_processes`), `method`, `promise`, `seed`, `separation`,
/// `asked` (`seconds` and `queries`, null without a limit, and `only`, a list of kinds, empty for all), `ended_by` ("time", "queries", "findings" or
/// "interrupt"), `queries`, `unjudged`, `unanswered`, `images`, `collisions`, `judged_by_oracle`, `seconds`,
/// `method_seconds`, `shrink_seconds`, `other_seconds`, `queries_per_second`, `judged_per_second`,
/// `all_findings`, `other_findings`, `unplaced_crashes`, `interrupted`, `generators` (a list of `name`, `queries`,
/// `collisions`, `coverage_keys`, `findings`) and `findings`, a list as above.
[[nodiscard]] nlohmann::json to_json(const FuzzReport& report);

}  // namespace touchstone::verify::fuzz

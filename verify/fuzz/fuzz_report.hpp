#pragma once

/// \file
/// The report of the fuzzer: as text for people, as JSON for programs. The JSON has all data of a
/// finding.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/fuzz.hpp"
#include "verify/solvers/child_process.hpp"

namespace touchstone::verify::fuzz {

/// A solver, and the arguments of its calls besides the query.
struct SolverCall {
  /// The name of one of methods(), or that of a plugin.
  std::string method;
  /// The plugin's library; empty for one of methods().
  std::filesystem::path plugin = {};
  /// The promise it is judged by.
  fast::Promise promise = fast::Promise::conservative;
  /// The terms of the promise, stated by the solver or on the command line.
  fast::Terms terms = {};
  /// With the separation that counts as contact.
  fast::MethodOptions options = {};
  /// Wall-clock seconds that a query may take; 0: no limit.
  double query_limit_seconds = 0.0;
  /// Limits of its process.
  solvers::ChildLimits limits = {};
};

/// A run and the request for it.
struct FuzzReport {
  SolverCall solver;  ///< the solver under test
  std::uint64_t seed = 0;
  double seconds = 0.0;                      ///< asked for; 0: no limit
  std::uint64_t queries = 0;                 ///< asked for; 0: no limit
  std::vector<judge::Fault> only = {};       ///< sought; empty: all
  std::vector<std::string> degrees = {"1"};  ///< of the curves, as they were asked for
  FuzzResult result;
};

/// "false_negative of METHOD, edge-edge: no, but they collide", for when a group is found.
[[nodiscard]] std::string to_line(const Finding& finding);

/// The numbers of a run, the reason for an early end, a table of the groups of findings, and the
/// plainest finding of each group in about ten lines: the fault, the truth and the points.
[[nodiscard]] std::string to_text(const FuzzReport& report);

/// The whole report. Numbers that may be infinite or NaN are written by io::number_to_json; missing
/// values are null. A finding has
///
/// - `what`, `kind`, `separation` (`min_separation`, `norm`), `method`, `generator`, `seconds`,
///   `queries`, `shrinking` and `group`, a place in `groups`;
/// - of the simplest query `degree`, `rational`, its `numbers` in one list, and in hexadecimal, as
///   text, the 24 `coordinates` on straight lines; on curves `control`, for each control point a
///   list of four points, and of rational curves `weights` likewise; `answer` (`verdict`,
///   `toi_lower`, `toi_upper`, `tolerance`), `collides`, `toi` (neighbouring doubles `lower` and
///   `upper`), `truth`, `detail`, and `certificate`, a stream that touchstone-check takes;
/// - `original`: the same of the query as it was found;
/// - `solver` (`method`, `plugin`, `promise`, `terms` as options of the command line, `time_error`
///   of times that are estimates, the options, and the limits of its process, `memory_limit` in
///   bytes), and `command`, which asks again.
///
/// `findings` is a list of these, and a group in `groups` has `best`, a place in `findings`, and in
/// words its Signature (recheck.hpp).
[[nodiscard]] nlohmann::json to_json(const FuzzReport& report);

}  // namespace touchstone::verify::fuzz

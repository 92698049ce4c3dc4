#pragma once

/// \file
/// The search for wrong answers of one solver.
///
/// Blocks of queries come from generators (generators.hpp), all of which are as likely. The solver
/// answers them in a child process (solver_process.hpp), the certified solver judges (recheck.hpp),
/// and the oracle judges a share again, and all doubtful answers. Some queries are asked once more
/// as an exact image (symmetry.hpp). All queries of a block are of one shape; by default they are
/// on straight lines.
///
/// The same seed gives the same queries and findings on every machine, for any solver that answers
/// the same: counted work steers the search, and the clock only ends it. (A query near the time
/// limit may or may not hang.)

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "verify/base/any_query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/solvers/child_process.hpp"

namespace touchstone::verify::fuzz {

struct FuzzOptions {
  /// Wall-clock seconds, including all work on findings; 0: no limit. Answers given by then are
  /// judged for a second more.
  double seconds = 0.0;
  /// Queries asked, images included; 0: no limit. The run ends exactly there.
  std::uint64_t most_queries = 0;
  std::uint64_t seed = 2021;
  /// Minimum separation.
  Separation separation = {};
  /// Passed on to the method, with the separation of above; t_max must be 1.
  fast::MethodOptions method = {};
  /// The promise to judge the method by, if not its own.
  std::optional<fast::Promise> promise = std::nullopt;
  /// Wall-clock seconds a query may take; 0: no limit. Exact arithmetic takes one where coordinates
  /// from 2^-1074 to 2^1023 meet a distance in L2.
  double query_limit_seconds = 10.0;
  /// Limits of the method's process.
  solvers::ChildLimits limits = {};
  /// Groups of findings after which the run ends; 0: never.
  std::size_t most_groups = 0;
  /// Wall-clock seconds for simplifying the query of a finding, or a tenth of the rest of the run
  /// if that is less; 0: queries are not simplified.
  double shrink_seconds = 0.0;
  /// Kinds of findings that are sought; empty: all. Others are only counted.
  std::vector<judge::Fault> only = {};
  /// Queries to mutate. Those on straight lines are also mutated on curves.
  std::vector<base::AnyQuery> corpus = {};
  /// Shapes of queries to ask, one a block in turn; not empty, of degrees above 0.
  std::vector<AnyShape> shapes = {{.kind = ContactKind::vertex_face},
                                  {.kind = ContactKind::edge_edge}};
  /// The share of the queries that the oracle judges again; it judges all those of the method
  /// `certified`.
  double oracle_share = 0.01;
  /// Null, or a flag: once it is true, the run ends within a quarter of a second and the time of
  /// judging a few queries; some answers then remain unjudged.
  const std::atomic<bool>* stop = nullptr;
  /// Called now and then with the seconds of the run by the wall clock, and the queries asked.
  std::function<void(double, std::uint64_t)> on_progress = nullptr;
  /// Called with every finding that is kept, when it is found, made simpler and in a group.
  std::function<void(const Finding&)> on_finding = nullptr;
  /// The clock of all times above but the query limit's.
  base::SecondsClock clock = base::steady_seconds;
};

/// True if that kind of findings is sought.
[[nodiscard]] bool seeks(const FuzzOptions& options, judge::Fault what);

/// Options of the calls to the method.
[[nodiscard]] fast::MethodOptions method_options(const FuzzOptions& options);

/// The reason why a run ended.
enum class FuzzEnd : std::uint8_t { time, queries, findings, interrupt };

/// "time", "queries", "findings" or "interrupt".
[[nodiscard]] std::string_view to_string(FuzzEnd end);

/// Results of one generator.
struct GeneratorStatistics {
  std::string name;
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;  ///< of these, by the judge
  std::uint64_t findings = 0;    ///< all, kept or not
};

/// Findings that look alike from outside (Signature in recheck.hpp).
struct FindingGroup {
  /// The number of all its findings. A finding with the solver, kind of finding, shape of query,
  /// generator and exactness of the judge of a kept one is not examined further, but counted in its
  /// group.
  std::uint64_t count = 0;
  std::size_t best = 0;  ///< in FuzzResult::findings: the plainest kept finding
};

struct FuzzResult {
  std::uint64_t queries = 0;           ///< asked and judged, images included
  std::uint64_t unjudged = 0;          ///< answered, but the run was over before they were judged
  std::uint64_t outside = 0;           ///< made, not asked: outside the terms of the promise
  std::uint64_t left_out = 0;          ///< made, not asked: of generators whose queries hang
  double query_limit_seconds = 0.0;    ///< at the end: hangs shorten it (solvers/hang_limits.hpp)
  std::uint64_t unanswered = 0;        ///< asked, but the run was over before they were answered
  std::uint64_t images = 0;            ///< of those judged
  std::uint64_t collisions = 0;        ///< of these, by the judge
  std::uint64_t judged_by_oracle = 0;  ///< its share, and doubtful answers
  double seconds = 0.0;                ///< wall clock
  double method_seconds = 0.0;         ///< of these, waiting for the method
  double shrink_seconds = 0.0;         ///< of these, making findings simpler
  double other_seconds = 0.0;          ///< generating and judging: the rest
  std::vector<Finding> findings;       ///< in order; those that were kept
  std::vector<FindingGroup> groups;  ///< the most harmful first (judge::harm_of), then the plainest
  std::uint64_t all_findings = 0;    ///< kept or not
  std::uint64_t other_findings = 0;  ///< of kinds that were not sought, beside all these
  /// The number of times that the method ended its process at queries none of which does so alone.
  std::uint64_t unplaced_crashes = 0;
  solvers::CapturedOutput output;  ///< the output of the method
  std::vector<GeneratorStatistics> generators;
  FuzzEnd ended_by = FuzzEnd::time;

  /// 0 if there are none or they took no time.
  [[nodiscard]] double queries_per_second() const;
  /// Without the method's time and that of making findings simpler.
  [[nodiscard]] double judged_per_second() const;
};

/// Looks for wrong answers of the method until the clock, the number of queries, the number of
/// findings or `stop` ends it. \pre one of these is given, and options are in their range
/// \throws std::invalid_argument if the method answers none of the shapes; std::system_error if no
/// process can be made.
[[nodiscard]] FuzzResult fuzz(const fast::Method& method, const FuzzOptions& options);

}  // namespace touchstone::verify::fuzz

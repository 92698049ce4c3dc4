#pragma once

/// \file
/// The search for wrong answers to queries on curves.
///
/// Blocks of queries are drawn: families of known truth and small whole numbers, which have many
/// degenerate contacts, any numbers, and weights; then some numbers are changed by a last place, by
/// a power of two, or to the number of another point. The oracle judges all answers. The same seed
/// gives the same queries on every machine; the clock only ends the run.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/curved_query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::fuzz {

struct CurvedFuzzOptions {
  double seconds = 0.0;            ///< wall clock; 0: no limit
  std::uint64_t most_queries = 0;  ///< 0: no limit
  std::uint64_t seed = 2021;
  std::uint64_t most_findings = 20;  ///< after which the run ends; 0: never
  std::vector<Kind> kinds = {Kind::vertex_face, Kind::edge_edge};
  fast::MethodOptions method = {};
  /// What breaks it is a finding.
  fast::Promise promise = fast::Promise::exact;
  /// May be null. Once true, the run ends.
  const std::atomic<bool>* stop = nullptr;
  /// Called now and then with the queries that are judged.
  std::function<void(std::uint64_t)> on_progress = nullptr;
  base::SecondsClock clock = base::steady_seconds;
};

/// A query with a wrong answer.
struct CurvedFinding {
  judge::Fault what;
  Kind kind;
  std::size_t degree;
  bool is_rational;
  std::vector<double> numbers;  ///< as CurvedQueries, of one query
  fast::Answer answer;
};

struct CurvedFuzzResult {
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;
  std::vector<CurvedFinding> findings;
};

/// The answers to a block.
using AnswerCurves = std::function<std::vector<fast::Answer>(Kind, const CurvedQueries&,
                                                             const fast::MethodOptions&)>;

/// \param is_low Only curves of degree 2 or 3 are asked.
[[nodiscard]] CurvedFuzzResult fuzz_curves(const AnswerCurves& answer, bool is_low,
                                           const CurvedFuzzOptions& options);

}  // namespace touchstone::verify::fuzz

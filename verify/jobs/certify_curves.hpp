#pragma once

/// \file
/// The truth of queries on curves, its proofs, and the certified solver and others judged by it.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/hang_limits.hpp"
#include "verify/solvers/plugin.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

/// A plugin to judge, with what its processes may do.
struct JudgedPlugin {
  solvers::CurvedPlugin plugin;
  fast::MethodOptions options = {};
  solvers::SolverProcessOptions process = {};
  /// The limits for hangs, which are counted over all calls.
  solvers::HangLimits limits{process.query_limit_seconds};
};

struct CurvedOptions {
  Separation separation = {};
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// The known times of impact, which the oracle is held to; empty: they are not known.
  std::span<const std::optional<double>> truth = {};
  /// Judge also tight_inclusion and the methods of verify/baselines/curved_methods.hpp, at distance
  /// 0, without weights.
  bool judge_others = false;
  /// Judge these, too.
  std::span<JudgedPlugin> plugins = {};
  /// Write a certificate of each verdict.
  bool prove = false;
  /// Before each query's index in the label of its certificate.
  std::string label = {};
  /// Called for each query in order.
  std::function<void(std::size_t, const exact::Decision&)> on_truth = nullptr;
  /// Called with the certificates of consecutive queries.
  std::function<void(const std::string&)> on_certificates = nullptr;
  /// Called now and then with the fraction that is done.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further block is begun.
  const std::atomic<bool>* stop = nullptr;
};

/// A method's answers held to the truth.
struct CurvedJudgement {
  std::string_view name;
  std::size_t false_negatives = 0;
  std::size_t false_positives = 0;
  /// Contacts with a time after that of impact by more than 1e-9.
  std::size_t late = 0;
  double seconds = 0.0;
};

/// A plugin's answers held to the truth, by the rules of judge.hpp.
struct CurvedPluginResult {
  std::string name;
  fast::Promise promise = fast::Promise::none;
  judge::Judgement judgement;
  solvers::CapturedOutput output;

  /// How often it ended its process, threw, gave no answer, or took too long.
  [[nodiscard]] std::uint64_t failed() const {
    return judgement.errors() + judgement.count(judge::Fault::hang);
  }
  /// Is there a promise, and a fault that breaks it?
  [[nodiscard]] bool is_broken() const {
    return promise != fast::Promise::none && !keeps(judgement, promise);
  }
};

/// The outcome for the queries, or for the first ones if it was stopped.
struct CurvedResult {
  std::size_t queries = 0;
  std::size_t collide = 0;
  /// Of the certified solver: queries with a wrong verdict, or with an enclosure that does not hold
  /// the exact time.
  std::vector<std::size_t> wrong;
  std::array<std::size_t, fast::stages> decided_by{};
  /// Queries in which the oracle contradicts the known truth.
  std::vector<std::size_t> against_truth;
  /// Of the other methods.
  std::vector<CurvedJudgement> others;
  /// In the order of CurvedOptions::plugins.
  std::vector<CurvedPluginResult> plugins;
  /// Certificates, and queries whose proof exceeds the limits of the format.
  std::size_t certificates = 0;
  std::size_t beyond_limits = 0;
  /// Processor time a query in seconds.
  double oracle_seconds = 0.0;
  double certified_seconds = 0.0;
  /// For each query its exact time of impact rounded to double, or NaN.
  std::vector<double> toi;
};

[[nodiscard]] CurvedResult certify_curves(Kind kind, const CurvedQueries& queries,
                                          const CurvedOptions& options);

}  // namespace touchstone::verify::jobs

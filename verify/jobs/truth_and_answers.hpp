#pragma once

/// \file
/// The truth about a block of queries and the answers to it: the verdicts of the oracle, the labels
/// compared with them, and certificates; the answers of one solver, and the judgement on them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/judge/label.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

struct CertifyResult;

struct BlockTruthOptions {
  Separation separation = fast::no_separation;
  judge::LabelComparison comparison = {};
  bool times = false;         ///< true if times of impact are needed
  bool certificates = false;  ///< true if certificates are to be written
  exact::ProveOptions proof = {};
};

/// The results of the oracle for a part of a block.
struct DecidedPart {
  std::vector<judge::Mismatch> mismatches;
  double nanoseconds = 0.0;
  std::string certificates;
  ProofCounts proofs;
};

/// The truth about the queries of one block.
class BlockTruth {
 public:
  /// Decides all queries in one of the passes. The block must live as long as this.
  BlockTruth(const QueryBlock& block, BlockTruthOptions options, Passes& passes);

  /// By query, without times where these are not needed.
  [[nodiscard]] std::span<const judge::GroundTruth> truths() const { return truths_; }
  /// The parts of the first `count` queries.
  [[nodiscard]] std::span<const DecidedPart> parts(std::size_t count) const;
  /// Adds counts and mismatches of the first `count` queries.
  void add_to(CertifyResult& result, std::size_t count) const;

 private:
  void decide(std::size_t first, std::size_t count, DecidedPart& part);
  void prove(std::size_t first, const std::vector<exact::Decision>& verdicts,
             DecidedPart& part) const;

  const QueryBlock& block_;
  BlockTruthOptions options_;
  std::vector<judge::GroundTruth> truths_;
  std::vector<DecidedPart> parts_;
};

/// The answers of a solver to the queries of one block. All below is about the first `count` of
/// them, no more than are complete (Passes::complete). A call may reach beyond these; it then
/// counts in part.
class BlockAnswers {
 public:
  /// Asks the solver in one of the passes. The block and the solver must live as long as this.
  BlockAnswers(const QueryBlock& block, const solvers::Solver& solver, const Separation& separation,
               Passes& passes);

  /// By query.
  [[nodiscard]] std::span<const fast::Answer> answers() const { return answers_; }
  /// The failure at query i that the solver reports with the answers, or null.
  [[nodiscard]] const judge::Failure* failure(std::size_t i) const;
  /// The reason why query i was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t i) const;
  /// The answer to query i as a person is shown it, unless the solver has none.
  [[nodiscard]] std::optional<judge::GivenAnswer> given(std::size_t i) const;

  /// The judgement on the first `count` answers. \param truths empty: queries are only counted
  [[nodiscard]] judge::Judgement judge(std::size_t count,
                                       std::span<const judge::GroundTruth> truths) const;
  /// Processor time.
  [[nodiscard]] double nanoseconds(std::size_t count) const;
  [[nodiscard]] std::uint64_t unplaced_crashes(std::size_t count) const;

 private:
  /// A call, which answers queries from a multiple of Passes::unit on.
  struct Call {
    std::size_t count = 0;  ///< of queries; 0: no call begins here
    solvers::SolveReply reply;
  };

  const QueryBlock& block_;
  const solvers::Solver& solver_;
  Separation separation_;
  std::vector<fast::Answer> answers_;
  std::vector<Call> calls_;               ///< by the unit of their first query
  std::vector<std::size_t> begins_ = {};  ///< by unit: the first query of its call
};

}  // namespace touchstone::verify::jobs

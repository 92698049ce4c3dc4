#pragma once

/// \file
/// The oracle's part of the judgement on a block of queries: verdicts, labels compared with them,
/// and certificates.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/label.hpp"

namespace touchstone::verify::jobs {

struct CertifyResult;

struct BlockTruthOptions {
  Separation separation = fast::no_separation;
  judge::LabelComparison comparison = {};
  bool times = false;         ///< Are times of impact needed?
  bool certificates = false;  ///< Are certificates to be written?
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
  BlockTruth(const Block& block, BlockTruthOptions options, Passes& passes);

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

  const Block& block_;
  BlockTruthOptions options_;
  std::vector<judge::GroundTruth> truths_;
  std::vector<DecidedPart> parts_;
};

}  // namespace touchstone::verify::jobs

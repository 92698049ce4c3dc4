#pragma once

/// \file
/// The answers of one solver to a block of queries, and the judgement on them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

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
  /// Why query i was not asked; nothing if it was.
  [[nodiscard]] std::optional<judge::Unasked> why_unasked(std::size_t i) const;
  /// The answer to query i as a person is shown it, unless the solver has none.
  [[nodiscard]] std::optional<judge::GivenAnswer> given(std::size_t i) const;

  /// The judgement on the first `count` answers. \param truths empty: only what was asked counts
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

#pragma once

/// \file
/// The answers of one solver to a block of queries, and the judgement on them.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "verify/jobs/stream.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

/// What a solver answered to the queries of one block.
class BlockAnswers {
 public:
  /// Asks the solver in one of the passes. Block and solver must live as long as this.
  BlockAnswers(const Block& block, const solvers::Solver& solver, const Separation& separation,
               Passes& passes);

  /// The judgement on the first answers, as many as there are truths. A part may reach beyond them; it then counts as
  /// far as they go.
  [[nodiscard]] judge::Judgement judge(std::span<const judge::GroundTruth> truths) const;

  /// The answer to query i, unless the solver has none. \pre it is complete (Passes::complete)
  [[nodiscard]] std::optional<judge::GivenAnswer> given(std::size_t i) const;

 private:
  /// The queries of one call, known by the first of them.
  struct Part {
    std::size_t count = 0;  ///< 0: no part begins here
    solvers::SolveReply reply;
  };

  const Block& block_;
  const solvers::Solver& solver_;
  Separation separation_;
  std::vector<fast::Answer> answers_;
  std::vector<Part> parts_;
};

}  // namespace touchstone::verify::jobs

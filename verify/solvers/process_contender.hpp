#pragma once

/// \file
/// A solver in a benchmark that runs in a child process.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "fast/method.hpp"
#include "verify/solvers/contender.hpp"
#include "verify/solvers/failure.hpp"
#include "verify/solvers/solver_process.hpp"

namespace touchstone::verify {

/// A method in a child process: a crash or a hang costs a query, which is not asked again.
class ProcessContender final : public Contender {
 public:
  /// The method must live as long as the contender.
  ProcessContender(const fast::Method& method, const fast::MethodOptions& options,
                   const SolverProcessOptions& process);

  void solve(Kind kind, std::span<const Query> queries) override;
  [[nodiscard]] std::optional<double> nanoseconds_elsewhere() const override;
  [[nodiscard]] fast::Answer answer(std::size_t i) const override { return answers_[i]; }
  [[nodiscard]] const Failure* failure(std::size_t i) const override;
  [[nodiscard]] std::uint64_t unplaced_crashes() const override { return unplaced_crashes_; }
  [[nodiscard]] CapturedOutput take_output() override { return process_.take_output(); }

 private:
  /// A query that it is not asked again.
  struct Lost {
    Kind kind;
    Query query;
    Failure failure;
  };

  [[nodiscard]] const Lost* find_lost(Kind kind, const Query& query) const;
  void ask(Kind kind, std::span<const Query> queries, std::size_t first, std::size_t last);

  SolverProcess process_;
  fast::MethodOptions options_;
  std::vector<fast::Answer> answers_;
  std::vector<QueryFailure> failures_;
  std::vector<Lost> lost_;
  double nanoseconds_ = 0.0;
  std::uint64_t unplaced_crashes_ = 0;
};

}  // namespace touchstone::verify

#pragma once

/// \file
/// The wall-clock time of a run over several sources, shared so that neither a slow source nor a
/// slow solver takes that of the others.
///
/// Each source has an equal part of what is left. Each solver has an account of its own, an equal
/// part of nearly all of the time, and of that in each source an equal part of what is left. Behind
/// it the solver leaves out queries (Solver::allow). A query that was begun may end: what it takes
/// too much is missing in the next sources.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "verify/base/deadline.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

class Budget {
 public:
  /// No limit.
  Budget() = default;

  /// \param seconds positive
  /// \param threads that ask each solver, 0: all cores
  Budget(double seconds, std::span<const solvers::Solver* const> solvers, unsigned threads,
         base::SecondsClock clock = base::steady_seconds);

  /// Begins one of the sources that are left: lets each solver have its part, and returns the
  /// deadline behind which no further queries are to be read.
  [[nodiscard]] base::Deadline begin_source(std::size_t sources_left);

  [[nodiscard]] bool is_limited() const { return end_.has_value(); }
  [[nodiscard]] bool is_over() const { return end_ && end_->is_over(); }

 private:
  struct Account {
    const solvers::Solver* solver;
    double seconds;      ///< that are left, without those given
    double given = 0.0;  ///< for the latest source
  };

  std::optional<base::Deadline> end_;
  base::SecondsClock clock_;
  std::vector<Account> accounts_;
};

}  // namespace touchstone::verify::jobs

#pragma once

/// \file
/// The wall-clock time of a run over several sources. The remaining sources share the remaining
/// time equally, and within a source the solvers share nearly all of it equally, so that neither a
/// slow source nor a slow solver takes the time of the others. When a solver's share is used up,
/// its further queries are skipped (Solver::allow); a query that was begun may end.

#include <cstddef>
#include <optional>
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
  Budget(double seconds, std::vector<const solvers::Solver*> solvers, unsigned threads,
         const base::SecondsClock& clock = base::steady_seconds);

  /// Begins one of the sources that are left: gives each solver its share, and returns the deadline
  /// after which no further queries are to be read.
  [[nodiscard]] base::Deadline begin_source(std::size_t sources_left) const;

  [[nodiscard]] bool is_limited() const { return end_.has_value(); }
  [[nodiscard]] bool is_over() const { return end_ && end_->is_over(); }

 private:
  std::optional<base::Deadline> end_;
  std::vector<const solvers::Solver*> solvers_;
  int threads_ = 1;
};

}  // namespace touchstone::verify::jobs

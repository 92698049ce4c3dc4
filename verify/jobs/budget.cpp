#include "verify/jobs/budget.hpp"

#include <algorithm>
#include <utility>

#include "verify/base/cores.hpp"

namespace touchstone::verify::jobs {

Budget::Budget(double seconds, std::vector<const solvers::Solver*> solvers, unsigned threads,
               const base::SecondsClock& clock)
    : end_(base::Deadline(seconds, clock)),
      solvers_(std::move(solvers)),
      threads_(base::cores_for(threads)) {}

base::Deadline Budget::begin_source(std::size_t sources_left) const {
  if (!end_) return {};
  // The rest is for the oracle, the reading and the writing.
  constexpr double solvers_part = 0.8;
  const double seconds =
      end_->seconds_left() / static_cast<double>(std::max<std::size_t>(sources_left, 1));
  for (const solvers::Solver* solver : solvers_) {
    solver->allow(solvers_part * seconds * threads_ / static_cast<double>(solvers_.size()));
  }
  return end_->at_most(seconds);
}

}  // namespace touchstone::verify::jobs

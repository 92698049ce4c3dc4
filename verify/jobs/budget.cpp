#include "verify/jobs/budget.hpp"

#include <algorithm>
#include <utility>

#include "verify/base/cores.hpp"

namespace touchstone::verify::jobs {
namespace {

/// The rest is for the oracle, the reading and the writing.
constexpr double solvers_part = 0.8;

}  // namespace

Budget::Budget(double seconds, std::span<const solvers::Solver* const> solvers, unsigned threads,
               base::SecondsClock clock)
    : end_(base::Deadline(seconds, clock)), clock_(std::move(clock)) {
  const double all = solvers_part * seconds * base::cores_for(threads);
  for (const solvers::Solver* solver : solvers) {
    accounts_.push_back({.solver = solver, .seconds = all / static_cast<double>(solvers.size())});
  }
}

base::Deadline Budget::begin_source(std::size_t sources_left) {
  if (!end_) return {};
  const auto left = static_cast<double>(std::max<std::size_t>(sources_left, 1));
  for (Account& account : accounts_) {
    if (account.given > 0.0) account.seconds += account.solver->allowance();
    account.given = std::max(0.0, account.seconds) / left;
    account.seconds -= account.given;
    account.solver->allow(account.given);
  }
  return base::Deadline(end_->seconds_left() / left, clock_);
}

}  // namespace touchstone::verify::jobs

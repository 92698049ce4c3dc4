#include "verify/solvers/process_contender.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace touchstone::verify {

ProcessContender::ProcessContender(const fast::Method& method, const fast::MethodOptions& options,
                                   const SolverProcessOptions& process)
    : Contender(std::string(method.name()), method.promise()),
      process_(method, process),
      options_(options) {}

void ProcessContender::solve(Kind kind, std::span<const Query> queries) {
  if (answers_.size() < queries.size()) answers_.resize(queries.size());
  failures_.clear();
  nanoseconds_ = 0.0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < queries.size() && !lost_.empty(); ++i) {
    const Lost* const lost = find_lost(kind, queries[i]);
    if (lost == nullptr) continue;
    const Failure failure = lost->failure;
    ask(kind, queries, first, i);
    answers_[i] = {.verdict = verdict_of(failure.kind)};
    failures_.push_back({.position = i, .failure = failure});
    first = i + 1;
  }
  ask(kind, queries, first, queries.size());
}

void ProcessContender::ask(Kind kind, std::span<const Query> queries, std::size_t first,
                           std::size_t last) {
  const std::size_t count = last - first;
  SolverRun run = process_.solve(kind, queries.subspan(first, count),
                                 std::span(answers_).subspan(first, count), options_);
  nanoseconds_ += 1e9 * run.processor_seconds;
  unplaced_crashes_ += run.unplaced_crashes;
  // Of a run that was stopped, nothing is known of the rest.
  std::fill(answers_.begin() + static_cast<std::ptrdiff_t>(first + run.answered),
            answers_.begin() + static_cast<std::ptrdiff_t>(last), fast::Answer{});
  for (QueryFailure& failure : run.failures) {
    failure.position += first;
    if (failure.failure.kind != FailureKind::exception) {
      lost_.push_back(
          {.kind = kind, .query = queries[failure.position], .failure = failure.failure});
    }
    failures_.push_back(std::move(failure));
  }
}

const ProcessContender::Lost* ProcessContender::find_lost(Kind kind, const Query& query) const {
  const auto is_it = [&](const Lost& lost) {
    return lost.kind == kind && lost.query.coordinates == query.coordinates;
  };
  const auto found = std::ranges::find_if(lost_, is_it);
  return found == lost_.end() ? nullptr : &*found;
}

std::optional<double> ProcessContender::nanoseconds_elsewhere() const { return nanoseconds_; }

const Failure* ProcessContender::failure(std::size_t i) const {
  const auto found = std::ranges::lower_bound(failures_, i, {}, &QueryFailure::position);
  return found != failures_.end() && found->position == i ? &found->failure : nullptr;
}

}  // namespace touchstone::verify

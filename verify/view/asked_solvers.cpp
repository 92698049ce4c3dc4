#include "verify/view/asked_solvers.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "verify/jobs/prove.hpp"

namespace touchstone::verify::view {
namespace {

/// The answer of a solver; nothing if it is not asked.
std::optional<judge::GivenAnswer> answer_of(const solvers::Solver& solver,
                                            const ViewedQuery& viewed) {
  judge::GivenAnswer given{.solver = solver.name(), .standard = solver.standard()};
  const std::array<std::uint64_t, 1> index{0};
  const solvers::SolveReply reply = solver.solve({.queries = viewed.query.queries(),
                                                  .separation = viewed.separation,
                                                  .source = viewed.label,
                                                  .indices = index},
                                                 {&given.answer, 1});
  if (!reply.unasked.empty()) return std::nullopt;
  if (!reply.failures.empty()) given.failure = reply.failures.front().failure;
  return given;
}

}  // namespace

Replies ask(std::span<const solvers::Solver* const> solvers, const ViewedQuery& viewed) {
  Replies replies;
  for (const solvers::Solver* solver : solvers) {
    if (auto given = answer_of(*solver, viewed)) {
      replies.answers.push_back(*std::move(given));
    } else if (!viewed.query.shape().is_straight() || !solver->terms().straight) {
      replies.notes.push_back(solver->name() + " is not asked: the query is outside its terms.");
    }
  }
  return replies;
}

ViewedQuery viewed_query(judge::WrongQuery wrong) {
  return {.label = jobs::certificate_label(wrong.source, wrong.index),
          .query = std::move(wrong.query),
          .separation = wrong.separation,
          .notes = std::move(wrong.faults),
          .answers = std::move(wrong.answers)};
}

}  // namespace touchstone::verify::view

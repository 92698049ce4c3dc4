#include "verify/view/asked_solvers.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "verify/jobs/prove.hpp"

namespace touchstone::verify::view {

std::vector<judge::GivenAnswer> answers_of(std::span<const solvers::Solver* const> solvers,
                                           const ViewedQuery& viewed) {
  std::vector<judge::GivenAnswer> answers;
  for (const solvers::Solver* solver : solvers) {
    judge::GivenAnswer given{.solver = solver->name(), .standard = solver->standard()};
    const std::array<std::uint64_t, 1> index{0};
    const solvers::SolveReply reply = solver->solve({.kind = viewed.kind,
                                                     .queries = {&viewed.query, 1},
                                                     .separation = viewed.separation,
                                                     .source = viewed.label,
                                                     .indices = index},
                                                    {&given.answer, 1});
    if (!reply.unasked.empty()) continue;
    if (!reply.failures.empty()) given.failure = reply.failures.front().failure;
    answers.push_back(std::move(given));
  }
  return answers;
}

ViewedQuery viewed_query(judge::WrongQuery wrong) {
  return {.label = jobs::certificate_label(wrong.source, wrong.index),
          .kind = wrong.kind,
          .query = wrong.query,
          .separation = wrong.separation,
          .notes = std::move(wrong.faults),
          .answers = std::move(wrong.answers)};
}

}  // namespace touchstone::verify::view

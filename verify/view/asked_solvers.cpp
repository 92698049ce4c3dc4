#include "verify/view/asked_solvers.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "fast/method.hpp"
#include "verify/jobs/prove.hpp"

namespace touchstone::verify::view {
namespace {

/// The answer of a solver; nothing if it is not asked.
std::optional<judge::GivenAnswer> answer_of(const solvers::Solver& solver,
                                            const base::AnyQuery& query,
                                            const ViewedQuery& viewed) {
  judge::GivenAnswer given{.solver = solver.name(), .standard = solver.standard()};
  const std::array<std::uint64_t, 1> index{0};
  const solvers::SolveReply reply = solver.solve({.queries = query.queries(),
                                                  .separation = viewed.separation,
                                                  .source = viewed.label,
                                                  .indices = index},
                                                 {&given.answer, 1});
  if (!reply.unasked.empty()) return std::nullopt;
  if (!reply.failures.empty()) given.failure = reply.failures.front().failure;
  return given;
}

/// The reason why a solver with these terms is not asked.
/// \param query in one shape; nothing if there is none
std::string reason_of(const fast::Terms& terms, Kind kind,
                      const std::optional<base::AnyQuery>& query) {
  if (!terms.answers(kind) || (query && terms.answers(query->shape()))) {
    return "the query is outside the terms of its promise";
  }
  if (query && query->shape().is_straight()) return "it takes no straight lines";
  if (terms.most_degree < terms.least_degree) return "it takes straight lines alone";
  if (!query && terms.least_degree <= 1) return "the curves differ in degree";
  const bool are_neighbours = terms.least_degree + 1 == terms.most_degree;
  return fmt::format("it takes {}curves of one degree, {} {} {}",
                     terms.rational ? "" : "polynomial ", terms.least_degree,
                     are_neighbours ? "or" : "to", terms.most_degree);
}

}  // namespace

Replies ask(std::span<const solvers::Solver* const> solvers, const ViewedQuery& viewed) {
  const std::optional<base::AnyQuery> query = in_one_shape(viewed);
  const bool is_straight = query && query->shape().is_straight();
  Replies replies;
  for (const solvers::Solver* solver : solvers) {
    if (auto given = query ? answer_of(*solver, *query, viewed) : std::nullopt) {
      replies.answers.push_back(*std::move(given));
    } else if (!is_straight || !solver->terms().straight) {
      replies.notes.push_back(fmt::format("{} is not asked: {}.", solver->name(),
                                          reason_of(solver->terms(), kind_of(viewed), query)));
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

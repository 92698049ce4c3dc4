#include "verify/view/asked_solvers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/curved_query.hpp"
#include "verify/data/curved_query_file.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/solvers/curved_answers.hpp"

namespace touchstone::verify::view {
namespace {

/// The same curves, all of one degree, as a constant one has each; nothing if others differ.
std::optional<data::CurvedQueryFile> of_one_degree(const CurvedQuery& curves) {
  data::CurvedQueryFile result{.degree = 0, .is_rational = false, .numbers = {}};
  for (const Trajectory& curve : curves) {
    result.degree = std::max(result.degree, curve.degree());
    result.is_rational = result.is_rational || !curve.weights.empty();
  }
  for (std::size_t j = 0; j <= result.degree; ++j) {
    for (const Trajectory& curve : curves) {
      if (curve.degree() != 0 && curve.degree() != result.degree) return std::nullopt;
      const std::size_t i = std::min(j, curve.degree());
      result.numbers.insert(result.numbers.end(), curve.control[i].begin(), curve.control[i].end());
      if (!result.is_rational) continue;
      result.numbers.push_back(curve.weights.empty() ? 1.0 : curve.weights[i]);
    }
  }
  return result;
}

}  // namespace

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

std::optional<judge::GivenAnswer> answer_on_curves(const ViewedQuery& viewed,
                                                   const std::string& method,
                                                   fast::MethodOptions options) {
  const std::optional<data::CurvedQueryFile> curves = of_one_degree(*viewed.curves);
  if (!curves || !solvers::answers_curves(method, curves->degree)) return std::nullopt;
  options.separation = viewed.separation;
  const auto answers = solvers::curved_answers(method, viewed.kind, curves->queries(), options, 1);
  return judge::GivenAnswer{.solver = method, .answer = answers.front()};
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

#include "verify/solvers/curved_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "touchstone/curved.hpp"
#include "touchstone/tight_inclusion.hpp"
#include "verify/base/cores.hpp"
#include "verify/solvers/answers.hpp"

namespace touchstone::verify::solvers {
namespace {

fast::Answer answer_of_inclusion(const fast::TightInclusionResult& result) {
  if (result.verdict != fast::Verdict::yes) return {.verdict = result.verdict};
  return {.verdict = result.verdict, .toi_lower = result.toi, .tolerance = result.tolerance};
}

}  // namespace

bool answers_curves(std::string_view method) {
  return method == "certified" || method == "tight_inclusion";
}

bool answers_curves(std::string_view method, std::size_t degree) {
  return method == "certified" || (answers_curves(method) && (degree == 2 || degree == 3));
}

std::vector<fast::Answer> curved_answers(std::string_view method, Kind kind,
                                         const CurvedQueries& queries,
                                         const fast::MethodOptions& options, unsigned threads) {
  if (!answers_curves(method)) {
    throw std::invalid_argument(fmt::format(
        "{} does not answer queries on curves; certified and tight_inclusion do", method));
  }
  std::vector<fast::Answer> answers(queries.size());
  if (method == "certified") {
    std::vector<fast::CertifiedResult> results(queries.size());
    fast::solve(kind, queries, results,
                {.t_max = options.t_max,
                 .separation = options.separation,
                 .max_threads = base::cores_for(threads)});
    std::ranges::transform(results, answers.begin(), answer_of);
    return answers;
  }
  const fast::TightInclusionOptions all{.tolerance = options.tolerance,
                                        .max_checks = options.max_checks,
                                        .separation = options.separation,
                                        .t_max = options.t_max};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i] = answer_of_inclusion(fast::tight_inclusion(kind, queries, i, all));
  }
  return answers;
}

}  // namespace touchstone::verify::solvers

// The facts of a view (verify/view/query_facts.hpp) as functions of WebAssembly, for pages that
// decide a query in the browser. One thread. The methods are those that need no rounding mode,
// which WebAssembly has not.

#include <emscripten/emscripten.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "fast/platform/arithmetic_check.hpp"
#include "verify/base/any_query.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/registry.hpp"
#include "verify/view/query_facts.hpp"

namespace touchstone::verify::playground {
namespace {

/// A page answers within a moment: a search stops earlier than usual.
constexpr std::int64_t most_checks = 20'000;

/// Nothing if the query is outside the terms of the method.
std::optional<judge::GivenAnswer> answer_of(const fast::Method& method, const base::AnyQuery& query,
                                            const Separation& separation) {
  const fast::MethodInfo& info = method.info();
  const base::AnyQuery asked = judge::as_asked(info.terms, query);
  if (!judge::admits(info.terms, asked, separation)) return std::nullopt;
  if (!is_zero(separation) && info.norms.empty()) return std::nullopt;
  judge::GivenAnswer given{.solver = std::string(info.name), .standard = judge::standard_of(info)};
  const fast::MethodOptions options{.max_checks = std::min(most_checks, info.usual_max_checks),
                                    .separation = separation};
  try {
    method.solve(asked.queries(), {&given.answer, 1}, options);
  } catch (const std::exception&) {
    given.answer = {.verdict = fast::Verdict::error};
  }
  return given;
}

nlohmann::json facts_of(const base::AnyQuery& query, const Separation& separation,
                        bool with_approach) {
  std::vector<judge::GivenAnswer> answers;
  for (const auto& method : solvers::methods()) {
    if (auto given = answer_of(*method, query, separation)) answers.push_back(*std::move(given));
  }
  return view::query_facts(
      {.label = "", .query = query, .separation = separation, .with_approach = with_approach},
      answers);
}

}  // namespace
}  // namespace touchstone::verify::playground

extern "C" {

/// The facts of a query as JSON, valid until the next call; {"error": REASON} if there are none.
/// \param coordinates 24
/// \param with_approach the distance of queries without a collision, too, which takes longest
EMSCRIPTEN_KEEPALIVE const char* touchstone_facts(int is_edge_edge, const double* coordinates,
                                                  double distance, int is_l2, int with_approach) {
  using namespace touchstone;
  static std::string text;
  try {
    const QueryShape lines{.kind = is_edge_edge != 0 ? Kind::edge_edge : Kind::vertex_face};
    const Separation separation{.distance = distance, .norm = is_l2 != 0 ? Norm::l2 : Norm::linf};
    const verify::base::AnyQuery query({lines, {coordinates, lines.numbers_of_query()}}, 0);
    text = verify::playground::facts_of(query, separation, with_approach != 0).dump();
  } catch (const std::exception& error) {
    text = nlohmann::json{{"error", error.what()}}.dump();
  }
  return text.c_str();
}

/// The reason why the solvers cannot use this machine's arithmetic; empty if they can.
EMSCRIPTEN_KEEPALIVE const char* touchstone_arithmetic_fault() {
  static std::string text;
  try {
    text.clear();
    touchstone::fast::require_strict_arithmetic();
  } catch (const std::exception& error) {
    text = error.what();
  }
  return text.c_str();
}
}

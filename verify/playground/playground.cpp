// The facts of a view (verify/view/query_facts.hpp), the certified solver and the checker as
// functions of WebAssembly, for the playground and for JavaScript (touchstone.js, which is
// appended). One thread. The methods are those that need no rounding mode, which WebAssembly has
// not.

#ifdef __EMSCRIPTEN__
#include <emscripten/emscripten.h>
#else  // a test of the list of sources
#define EMSCRIPTEN_KEEPALIVE [[gnu::visibility("default")]]
#endif

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
#include "touchstone/certified.hpp"
#include "verify/base/any_decision.hpp"
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
                        bool has_answers) {
  std::vector<judge::GivenAnswer> answers;
  if (has_answers) {
    for (const auto& method : solvers::methods()) {
      if (auto given = answer_of(*method, query, separation)) answers.push_back(*std::move(given));
    }
  }
  return view::query_facts(
      {.label = "", .query = query, .separation = separation, .with_approach = false}, answers);
}

nlohmann::json certified_answer(const base::AnyQuery& query, const Separation& separation) {
  fast::CertifiedResult result;
  base::solve(query.queries(), {&result, 1}, {.separation = separation});
  return {{"verdict", judge::to_string(result.verdict)},
          {"toi_lower", result.toi_lower},
          {"toi_upper", result.toi_upper},
          {"u", result.u},
          {"v", result.v}};
}

/// What a function says, as JSON; {"error": REASON} instead of an exception. Valid until the next
/// call.
template <class Function>
const char* said(const Function& function) {
  static std::string text;
  try {
    text = function().dump();
  } catch (const std::exception& error) {
    text = nlohmann::json{{"error", error.what()}}.dump();
  }
  return text.c_str();
}

/// What the function says of a query of 24 coordinates.
template <class Function>
const char* said_of(int is_edge_edge, const double* coordinates, double distance, int is_l2,
                    const Function& function) {
  return said([&] {
    const AnyShape lines{.kind =
                             is_edge_edge != 0 ? ContactKind::edge_edge : ContactKind::vertex_face};
    const Separation separation{.distance = distance, .norm = is_l2 != 0 ? Norm::l2 : Norm::linf};
    const base::AnyQuery query({lines, {coordinates, lines.numbers_of_query()}}, 0);
    return function(query, separation);
  });
}

}  // namespace
}  // namespace touchstone::verify::playground

extern "C" {

/// The facts of a query as JSON, but for the distance of one without a collision, which takes
/// longest. \param has_answers with the answers of solvers, too
EMSCRIPTEN_KEEPALIVE const char* touchstone_facts(int is_edge_edge, const double* coordinates,
                                                  double distance, int is_l2, int has_answers) {
  namespace playground = touchstone::verify::playground;
  return playground::said_of(is_edge_edge, coordinates, distance, is_l2,
                             [&](const auto& query, const auto& separation) {
                               return playground::facts_of(query, separation, has_answers != 0);
                             });
}

/// The answer of the certified solver as JSON; numbers that there are not are null.
EMSCRIPTEN_KEEPALIVE const char* touchstone_solve(int is_edge_edge, const double* coordinates,
                                                  double distance, int is_l2) {
  namespace playground = touchstone::verify::playground;
  return playground::said_of(is_edge_edge, coordinates, distance, is_l2,
                             playground::certified_answer);
}

/// What the checker says of a certificate of one query (verify/view/query_facts.hpp), as
/// JSON.
EMSCRIPTEN_KEEPALIVE const char* touchstone_check(const char* certificate) {
  using namespace touchstone::verify;
  return playground::said([&] { return view::certificate_facts(certificate); });
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

#include "verify/view/asked_solvers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::view::asked_solvers_test {
namespace {

/// A vertex in a resting triangle.
ViewedQuery resting() {
  const Query query = tests::over_triangle(1, 1, 0, 0).query;
  return {.label = "a label", .query = base::AnyQuery(Kind::vertex_face, query)};
}

/// What these methods say.
Replies ask_methods(const std::vector<std::string>& names, const ViewedQuery& query) {
  std::vector<std::unique_ptr<solvers::Solver>> made;
  std::vector<const solvers::Solver*> asked;
  for (const std::string& name : names) {
    made.push_back(solvers::solver_in_process(solvers::find_method(name), {.tolerance = 1e-3}));
    asked.push_back(made.back().get());
  }
  return ask(asked, query);
}

TEST(Ask, AnswersAreThoseOfSolversWithinTheirTerms) {
  const Replies replies = ask_methods({"certified", "accd_limited"}, resting());
  const std::vector<judge::GivenAnswer>& answers = replies.answers;
  ASSERT_EQ(answers.size(), 1U) << "ACCD's promise is about primitives that start apart";
  EXPECT_EQ(answers[0].solver, "certified");
  EXPECT_EQ(answers[0].answer.verdict, fast::Verdict::yes);
  ASSERT_TRUE(answers[0].standard.has_value());
  EXPECT_EQ(answers[0].standard->promise, fast::Promise::exact);
  EXPECT_TRUE(replies.notes.empty());
}

/// A vertex falls to a triangle at rest and through it, on a curve through these heights.
OwnCurves on_curves(const std::vector<double>& heights) {
  OwnCurves own{.curves = {{{}, {.control = {{0, 0, 0}}}, {.control = {{4, 0, 0}}}, {}}}};
  for (const double z : heights) own.curves[0].control.push_back({1, 1, z});
  own.curves[3].control = {{0, 4, 0}, {0, 4, 0}, {0, 4, 0}};
  return own;
}

TEST(Ask, CurvesOfDegreeOneAsStraightLines) {
  OwnCurves lines = on_curves({1, -1});
  lines.curves[3] = {.control = {{0, 4, 0}}};
  const Replies replies =
      ask_methods({"certified", "tight_inclusion", "accd"}, {.label = "lines", .query = lines});
  ASSERT_EQ(replies.answers.size(), 3U);
  for (const judge::GivenAnswer& given : replies.answers) {
    EXPECT_EQ(given.answer.verdict, fast::Verdict::yes) << given.solver;
  }
}

/// A method of these terms that is never asked.
std::vector<std::string> notes_of(const fast::Terms& terms, const ViewedQuery& query) {
  const tests::FunctionMethod method(
      [](Kind, const Query&) { return fast::Answer{.verdict = fast::Verdict::no}; },
      {.name = "method", .terms = terms});
  const auto solver = solvers::solver_in_process(method, {});
  const std::array<const solvers::Solver*, 1> asked{solver.get()};
  const Replies replies = ask(asked, query);
  EXPECT_TRUE(replies.answers.empty());
  return replies.notes;
}

TEST(Ask, NotesSayWhoIsNotAskedAndWhy) {
  struct Row {
    std::string_view reason;  ///< empty: nothing is said
    fast::Terms terms;
    ViewedQuery query;
  };
  const fast::Terms polynomial{.straight = false, .least_degree = 1, .most_degree = 8};
  const fast::Terms two_or_three{.least_degree = 2, .most_degree = 3, .rational = true};
  const ViewedQuery mixed{.label = "", .query = on_curves({1, 1})};
  ViewedQuery rational{.label = "", .query = on_curves({1, 1, 1})};
  std::get<OwnCurves>(rational.query).curves[0].weights = {1, 1, 1};
  const std::vector<Row> rows{
      {"it takes straight lines alone", {}, rational},
      {"it takes straight lines alone", {}, mixed},
      {"it takes polynomial curves of one degree, 1 to 8", polynomial, rational},
      {"the curves differ in degree", polynomial, mixed},
      {"it takes curves of one degree, 2 or 3", two_or_three, mixed},
      {"it takes no straight lines", polynomial, resting()},
      {"the query is outside the terms of its promise", {.kinds = {false, true}}, rational},
      {"", {.kinds = {false, true}}, resting()},
  };
  for (const auto& [reason, terms, query] : rows) {
    std::vector<std::string> expected;
    if (!reason.empty()) expected.push_back("method is not asked: " + std::string(reason) + ".");
    EXPECT_EQ(notes_of(terms, query), expected);
  }
}

}  // namespace
}  // namespace touchstone::verify::view::asked_solvers_test

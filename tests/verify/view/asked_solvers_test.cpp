#include "verify/view/asked_solvers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/support/queries.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::verify::view::asked_solvers_test {
namespace {

/// A vertex in a resting triangle.
ViewedQuery resting() {
  const tests::PosedQuery posed = tests::vertex_face({1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0},
                                                     {1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0});
  return {.label = "a label", .kind = posed.kind, .query = posed.query};
}

TEST(AnswersOf, AreThoseOfSolversWithinTheirTerms) {
  const auto certified = solvers::solver_in_process(solvers::find_method("certified"), {});
  const auto limited = solvers::solver_in_process(solvers::find_method("accd_limited"), {});
  const std::array<const solvers::Solver*, 2> asked{certified.get(), limited.get()};
  const auto answers = answers_of(asked, resting());
  ASSERT_EQ(answers.size(), 1U) << "ACCD's promise is about primitives that start apart";
  EXPECT_EQ(answers[0].solver, "certified");
  EXPECT_EQ(answers[0].answer.verdict, fast::Verdict::yes);
  ASSERT_TRUE(answers[0].standard.has_value());
  EXPECT_EQ(answers[0].standard->promise, fast::Promise::exact);
}

/// A vertex falls to a triangle at rest and through it, on a curve through these heights.
ViewedQuery on_curves(const std::vector<double>& heights) {
  CurvedQuery curves{{{}, {.control = {{0, 0, 0}}}, {.control = {{4, 0, 0}}}, {}}};
  for (const double z : heights) curves[0].control.push_back({1, 1, z});
  curves[3].control = {{0, 4, 0}, {0, 4, 0}, {0, 4, 0}};
  return {.label = "curved", .curves = curves};
}

std::optional<judge::GivenAnswer> asked(const ViewedQuery& query,
                                        const std::string& method = "certified") {
  return answer_on_curves(query, method, {.tolerance = 1e-3});
}

TEST(AnswerOnCurves, IsOfTheCertifiedSolver) {
  ViewedQuery query = on_curves({0.5, 0.5, -1.5});
  const auto answer = asked(query);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->solver, "certified");
  EXPECT_EQ(answer->answer.verdict, fast::Verdict::yes);
  EXPECT_LT(answer->answer.toi_lower, 0.5);
  EXPECT_GE(answer->answer.toi_upper, 0.5);
  EXPECT_NEAR(answer->answer.toi_lower, answer->answer.toi_upper, 1e-11);
  query.curves->at(2).weights = {0.5};
  EXPECT_NEAR(asked(query)->answer.toi_upper, 0.5, 1e-11);
  query.curves->at(0).weights = {1, 1, 2};
  EXPECT_LT(asked(query)->answer.toi_upper, 0.5);
  query.curves->at(0).control[2][2] = 0.25;
  EXPECT_EQ(asked(query)->answer.verdict, fast::Verdict::no);
  query.separation = {.distance = 0.25, .norm = Norm::l2};
  EXPECT_EQ(asked(query)->answer.verdict, fast::Verdict::yes);
}

TEST(AnswerOnCurves, IsOfTightInclusionInItsDegrees) {
  const auto answer = asked(on_curves({0.5, 0.5, -1.5}), "tight_inclusion");
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->solver, "tight_inclusion");
  EXPECT_EQ(answer->answer.verdict, fast::Verdict::yes);
  EXPECT_LE(answer->answer.toi_lower, 0.5);
  EXPECT_GT(answer->answer.tolerance, 0.0);
  EXPECT_EQ(asked(on_curves({1, 1, 1}), "tight_inclusion")->answer.verdict, fast::Verdict::no);
  ViewedQuery lines = on_curves({1, 1});
  lines.curves->at(3) = {.control = {{0, 4, 0}}};
  EXPECT_TRUE(asked(lines));
  EXPECT_FALSE(asked(lines, "tight_inclusion"));
}

TEST(AnswerOnCurves, NeedsOneDegreeOfThoseThatMove) {
  EXPECT_TRUE(asked(on_curves({1, 1, 1})).has_value());
  EXPECT_TRUE(asked(on_curves({1})).has_value());
  EXPECT_FALSE(asked(on_curves({1, 1})).has_value());
}

}  // namespace
}  // namespace touchstone::verify::view::asked_solvers_test

#include "verify/view/asked_solvers.hpp"

#include <gtest/gtest.h>

#include <array>

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

TEST(ViewedQueryOf, HasTheFaultsAsNotes) {
  const ViewedQuery query = resting();
  const ViewedQuery viewed = viewed_query({.source = "a.csv",
                                           .index = 7,
                                           .kind = query.kind,
                                           .query = query.query,
                                           .separation = {.distance = 0.5},
                                           .faults = {"late"},
                                           .answers = {{.solver = "x"}}});
  EXPECT_EQ(viewed.label, "a.csv:7");
  EXPECT_EQ(viewed.query, query.query);
  EXPECT_EQ(viewed.separation.distance, 0.5);
  EXPECT_EQ(viewed.notes, std::vector<std::string>{"late"});
  EXPECT_EQ(viewed.answers.at(0).solver, "x");
}

}  // namespace
}  // namespace touchstone::verify::view::asked_solvers_test

#include "verify/jobs/certify.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/methods.hpp"

namespace touchstone::verify::jobs::budget_test {
namespace {

using tests::FunctionMethod;
using tests::true_answer;

struct Solvers {
  FunctionMethod method{true_answer};
  std::unique_ptr<solvers::Solver> first = solvers::solver_in_process(method, {});
  std::unique_ptr<solvers::Solver> second = solvers::solver_in_process(method, {});
  std::vector<const solvers::Solver*> all{first.get(), second.get()};
};

TEST(Budget, SharesWhatIsLeftOverSourcesAndSolvers) {
  Solvers solvers;
  double now = 0.0;
  Budget budget(100.0, solvers.all, 1, [&] { return now; });
  EXPECT_EQ(budget.begin_source(4).seconds_left(), 25.0);
  EXPECT_DOUBLE_EQ(solvers.first->allowance(), 10.0);
  EXPECT_DOUBLE_EQ(solvers.second->allowance(), 10.0);
  // What a solver took too much is missing for all.
  solvers.first->allow(-10.0);
  now = 40.0;
  EXPECT_EQ(budget.begin_source(3).seconds_left(), 20.0);
  EXPECT_DOUBLE_EQ(solvers.first->allowance(), 8.0);
  EXPECT_DOUBLE_EQ(solvers.second->allowance(), 8.0);
  now = 100.0;
  EXPECT_TRUE(budget.is_over());
  EXPECT_TRUE(budget.begin_source(1).is_over());
  EXPECT_EQ(solvers.first->allowance(), 0.0);
}

TEST(Budget, WithoutTimeQueriesAreLeftOut) {
  Solvers solvers;
  solvers.first->allow(0.0);
  const std::vector<Query> queries(3);
  std::vector<fast::Answer> answers(3);
  const auto reply = solvers.first->solve({.queries = {Kind::vertex_face, queries}}, answers);
  ASSERT_EQ(reply.unasked.size(), 3U);
  EXPECT_EQ(reply.unasked.front().why, judge::Unasked::left_out);
  EXPECT_FALSE(reply.stopped);
}

}  // namespace
}  // namespace touchstone::verify::jobs::budget_test

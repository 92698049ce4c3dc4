#include "tests/faults/hunt.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string_view>

#include "verify/fuzz/plainness.hpp"
#include "verify/generate/everyday.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::tests::hunt_test {
namespace {

TEST(FaultHunt, IsOfFaultsWithNamesOfTheirOwnAndThePromisesOfTheirMethods) {
  std::set<std::string_view> names;
  for (const FaultySolver& solver : faulty_solvers()) {
    EXPECT_TRUE(names.insert(solver.fault.name).second) << solver.fault.name;
    EXPECT_EQ(solver.make()->promise(), verify::solvers::find_method(solver.of).promise())
        << solver.fault.name;
    EXPECT_EQ(&find_faulty_solver(solver.fault.name), &solver);
  }
  EXPECT_GE(names.size(), 15U);
  EXPECT_THROW((void)find_faulty_solver("none"), std::invalid_argument);
}

TEST(FaultHunt, FindsEachFault) {
  for (const FaultySolver& solver : faulty_solvers()) {
    if (!solver.fault.is_to_be_found()) continue;
    const Hunt found = hunt(solver, {.seconds = 0.0, .queries = 300'000});
    ASSERT_TRUE(found.finding) << solver.fault.name;
    EXPECT_EQ(found.finding->method, solver.fault.name);
  }
}

TEST(FaultHunt, FindsNothingWhereAFaultIsHarmless) {
  for (const FaultySolver& solver : faulty_solvers()) {
    if (solver.fault.harmless.empty()) continue;
    const Hunt found = hunt(solver, {.seconds = 0.0, .queries = 10'000});
    EXPECT_FALSE(found.finding) << solver.fault.name;
    EXPECT_EQ(found.queries, 10'000U);
  }
}

TEST(FaultHunt, EndsInASimpleQuery) {
  const FaultySolver& solver = find_faulty_solver("root_at_start_missing");
  const Hunt found = hunt(solver, {.seconds = 0.0, .queries = 100'000});
  ASSERT_TRUE(found.finding);
  const verify::base::AnyQuery query = simplest(solver, *found.finding);
  EXPECT_EQ(verify::fuzz::shape_of(query), verify::fuzz::Shape::general);
  EXPECT_LE(verify::fuzz::magnitudes(query).size(), 2U);
  for (const double x : verify::fuzz::magnitudes(query)) {
    EXPECT_EQ(verify::generate::shortest_decimal(x).count, 1) << x;
  }
}

}  // namespace
}  // namespace touchstone::tests::hunt_test

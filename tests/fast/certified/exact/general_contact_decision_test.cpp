#include "fast/certified/exact/general_contact_decision.hpp"

#include <gtest/gtest.h>

#include "tests/fast/certified/decisions.hpp"

namespace touchstone::fast::exact_stage::general_contact_decision_test {
namespace {

using tests::PosedQuery;

std::optional<ExactImpact> decide(const PosedQuery& posed) {
  return first_impact(tests::integer_motion<BigInteger>(posed), bits_of_one);
}

TEST(GeneralDecision, FindsATangentialContact) {
  // A vertex that would have to turn back: the triangle follows and leaves it again.
  const PosedQuery posed = tests::twisting_triangle({0, 0, 0.0}, {1, 0, 0.0});
  tests::expect_truth(posed, decide(posed), 1);
}

TEST(GeneralDecision, EnclosesATimeBetweenNeighboursAndSaysWhere) {
  const auto impact = decide(tests::over_triangle(1, 1, 1, -2));  // at 1/3
  ASSERT_TRUE(impact.has_value());
  EXPECT_EQ(time_of(*impact).upper - time_of(*impact).lower, 1U);
  EXPECT_EQ(impact->u, 0.25);
  EXPECT_EQ(impact->v, 0.25);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::general_contact_decision_test

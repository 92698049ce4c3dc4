#include "fast/certified/exact/general_contact_decision.hpp"

#include <gtest/gtest.h>

#include "tests/fast/certified/decisions.hpp"

namespace touchstone::fast::exact_stage::general_contact_decision_test {
namespace {

using tests::integer_motion;
using tests::PosedQuery;
using tests::Random;

std::optional<Impact> decide(const PosedQuery& posed, std::uint64_t latest = bits_of_one) {
  return first_impact(integer_motion<BigInteger>(posed), latest);
}

TEST(GeneralDecision, AgreesWithTheOracleOnSmallIntegers) {
  Random random(1);
  for (int i = 0; i < 4000; ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const PosedQuery posed{kind, tests::integer_query(random, 1 + i % 4)};
    tests::expect_truth(posed, decide(posed), 1);
    if (HasFatalFailure()) return;
  }
}

TEST(GeneralDecision, FindsATangentialContact) {
  // A vertex that would have to turn back: the triangle follows and leaves it again.
  const PosedQuery posed = tests::twisting_triangle({0, 0, 0.0}, {1, 0, 0.0});
  tests::expect_truth(posed, decide(posed), 1);
}

TEST(GeneralDecision, TakesTheLatestTimeExactly) {
  const PosedQuery posed = tests::over_triangle(1, 1, 1, -3);  // at t = 1/4
  const auto quarter = std::bit_cast<std::uint64_t>(0.25);
  EXPECT_TRUE(decide(posed, quarter).has_value());
  EXPECT_FALSE(decide(posed, quarter - 1).has_value());
  const PosedQuery third = tests::over_triangle(1, 1, 1, -2);
  const auto impact = decide(third);
  ASSERT_TRUE(impact.has_value());
  EXPECT_EQ(impact->time.upper - impact->time.lower, 1U);
  EXPECT_FALSE(decide(third, impact->time.lower).has_value());
  EXPECT_TRUE(decide(third, impact->time.upper).has_value());
  EXPECT_EQ(impact->u, 0.25);
  EXPECT_EQ(impact->v, 0.25);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::general_contact_decision_test

#include "fast/certified/exact/contact_decision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>

#include "tests/fast/certified/decisions.hpp"

namespace touchstone::fast::exact_stage::contact_decision_test {
namespace {

using tests::integer_motion;
using tests::PosedQuery;
using tests::Random;

template <class Number>
FixedSizeAnswer decide(const PosedQuery& posed, std::uint64_t step = 1,
                       std::uint64_t latest = bits_of_one, double scale = 1.0) {
  return fixed_size_first_impact(integer_motion<Number>(posed, scale), latest, step);
}

/// Expects all decided queries to be right, and almost all to be decided.
template <class Number>
void expect_truth_of_small_integers(std::uint64_t seed, double scale) {
  Random random(seed);
  int undecided = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const PosedQuery posed{kind, tests::integer_query(random, 1 + i % 4)};
    const std::uint64_t step = i % 3 == 0 ? 4503 : 1;
    const FixedSizeAnswer answer = decide<Number>(posed, step, bits_of_one, scale);
    if (!answer.decided) {
      ++undecided;
      continue;
    }
    tests::expect_truth(posed, answer.impact, step);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_LT(undecided, count / 50);
}

TEST(FixedSizeDecision, AgreesWithTheOracleOnSmallIntegers) {
  expect_truth_of_small_integers<FixedInteger<1>>(1, 1.0);
}

TEST(FixedSizeDecision, AgreesWithTheOracleOnTheLargestIntegersItTakes) {
  // Differences of up to 16 in units of 2^57.
  expect_truth_of_small_integers<FixedInteger<1>>(2, 0x1p57);
  expect_truth_of_small_integers<FixedInteger<2>>(3, 0x1p57);
}

TEST(FixedSizeDecision, TakesTheLatestTimeExactly) {
  const PosedQuery posed = tests::over_edge(1, 1, 1, -2);  // at t = 1/3
  const FixedSizeAnswer answer = decide<FixedInteger<1>>(posed);
  ASSERT_TRUE(answer.decided && answer.impact);
  const BitInterval time = answer.impact->time;
  const FixedSizeAnswer before = decide<FixedInteger<1>>(posed, 1, time.lower),
                        after = decide<FixedInteger<1>>(posed, 1, time.upper);
  EXPECT_TRUE(before.decided && !before.impact);
  EXPECT_TRUE(after.decided && after.impact);
}

TEST(FixedSizeDecision, FindsATinyTimeThatIsNoSmallFraction) {
  const PosedQuery posed = tests::over_triangle(1, 1, 3, -0x1p43 - 1);
  const FixedSizeAnswer answer = decide<FixedInteger<1>>(posed);
  ASSERT_TRUE(answer.decided);
  tests::expect_truth(posed, answer.impact, 1);
}

TEST(FixedSizeDecision, DecidesSignsFarBelowTheWidthOfItsEnclosure) {
  // A vertex over the triangle's side x + y = 4, and one part in 2^52 beside it on either side.
  for (const double x : {1.0, std::nextafter(1.0, 2.0), std::nextafter(1.0, 0.0)}) {
    PosedQuery posed = tests::over_triangle(0x1p53 * x, 0x1p53 * 3, 0x1p20 + 1, -0x1p21);
    for (double& coordinate : std::span(posed.query.coordinates).subspan(3, 9))
      coordinate *= 0x1p53;
    for (double& coordinate : std::span(posed.query.coordinates).subspan(15, 9)) {
      coordinate *= 0x1p53;
    }
    const FixedSizeAnswer answer = decide<FixedInteger<1>>(posed);
    ASSERT_TRUE(answer.decided);
    tests::expect_truth(posed, answer.impact, 1);
  }
}

TEST(FixedSizeDecision, HandsOnWhatItCannotHold) {
  // A time near 3·2^-120.
  auto motion = integer_motion<FixedInteger<2>>(tests::over_triangle(1, 1, 3, -1));
  motion.r[2][1] = FixedInteger<2>(-(SignedWideLimb{1} << 120U));
  EXPECT_FALSE(fixed_size_first_impact(motion, bits_of_one, 1).decided);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::contact_decision_test

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

TEST(FixedSizeDecision, DecidesAlmostAllSmallIntegers) {
  Random random(1);
  for (const double scale : {1.0, 0x1p57}) {
    int undecided = 0;
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
      const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
      const PosedQuery posed{kind, tests::integer_query(random, 1 + i % 4)};
      undecided += decide<FixedInteger<1>>(posed, 1, bits_of_one, scale).decided ? 0 : 1;
      // An enclosure of more than a spacing.
      const FixedSizeAnswer wide = decide<FixedInteger<2>>(posed, 4503, bits_of_one, scale);
      if (wide.decided) tests::expect_truth(posed, wide.impact, 4503);
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_LT(undecided, count / 50);
  }
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

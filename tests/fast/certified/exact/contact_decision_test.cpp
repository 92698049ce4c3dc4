#include "fast/certified/exact/contact_decision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>

#include "fast/certified/block.hpp"
#include "tests/fast/certified/decisions.hpp"
#include "tests/support/certified_against_oracle.hpp"

namespace touchstone::fast::exact_stage::contact_decision_test {
namespace {

using tests::integer_motion;
using tests::PosedQuery;
using tests::Random;

template <class Number>
FixedSizeAnswer decide(const PosedQuery& posed, double scale = 1.0, std::uint64_t step = 1) {
  return fixed_size_first_impact(integer_motion<Number>(posed, scale), bits_of_one, step);
}

/// Expects the query's first contact, enclosed within the tolerance or one spacing of doubles. (The
/// place is not yet in the domain.)
void expect_truth(const PosedQuery& posed, const FixedSizeAnswer& answer, double tolerance = 0.0) {
  ASSERT_TRUE(answer.decided) << posed;
  CertifiedResult result = result_of(answer.impact);
  result.u = result.v = 0.0;
  const auto wrong = tests::fault(posed.kind, posed.query, result, {.toi_tolerance = tolerance});
  EXPECT_EQ(wrong.value_or(""), "") << posed;
}

TEST(FixedSizeDecision, DecidesAlmostAllSmallIntegers) {
  Random random(1);
  for (const double scale : {1.0, 0x1p57}) {
    int undecided = 0;
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
      const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
      const PosedQuery posed{kind, tests::integer_query(random, 1 + i % 4)};
      undecided += decide<FixedInteger<1>>(posed, scale).decided ? 0 : 1;
      // An enclosure of 4503 spacings.
      const FixedSizeAnswer wide = decide<FixedInteger<2>>(posed, scale, 4503);
      if (wide.decided) expect_truth(posed, wide, 1e-12);
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_LT(undecided, count / 50);
  }
}

TEST(FixedSizeDecision, FindsATinyTimeThatIsNoSmallFraction) {
  const PosedQuery posed = tests::over_triangle(1, 1, 3, -0x1p43 - 1);
  expect_truth(posed, decide<FixedInteger<1>>(posed));
}

TEST(FixedSizeDecision, DecidesSignsFarBelowTheWidthOfItsEnclosure) {
  // A vertex over the triangle's side x + y = 4, and one part in 2^52 beside it on either side.
  for (const double x : {1.0, std::nextafter(1.0, 2.0), std::nextafter(1.0, 0.0)}) {
    PosedQuery posed = tests::over_triangle(0x1p53 * x, 0x1p53 * 3, 0x1p20 + 1, -0x1p21);
    for (const std::size_t first : {3U, 15U}) {
      for (double& c : std::span(posed.query.coordinates).subspan(first, 9)) c *= 0x1p53;
    }
    expect_truth(posed, decide<FixedInteger<1>>(posed));
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

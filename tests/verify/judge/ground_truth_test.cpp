#include "verify/judge/ground_truth.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "tests/support/queries.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::judge::ground_truth_test {
namespace {

using exact::DoubleInterval;

TEST(GroundTruth, IsTheVerdictInDoubles) {
  const auto truth_about = [](const tests::PosedQuery& posed, const Separation& separation) {
    return truth_of(7, exact::decide(posed.kind, posed.query, separation));
  };
  const tests::PosedQuery falling = tests::over_triangle(1, 1, 2, -1);
  const GroundTruth at_two_thirds = truth_about(falling, {});
  EXPECT_EQ(at_two_thirds.index, 7U);
  EXPECT_TRUE(at_two_thirds.collides);
  EXPECT_EQ(at_two_thirds.toi, (DoubleInterval{0x1.5555555555555p-1, 0x1.5555555555556p-1}));
  EXPECT_EQ(truth_about(falling, {.distance = 0.5, .norm = Norm::linf}).toi,
            (DoubleInterval{0.5, 0.5}));
  const GroundTruth never = truth_about(tests::over_triangle(1, 1, 2, 1), {});
  EXPECT_FALSE(never.collides);
  EXPECT_EQ(never.toi, std::nullopt);
}

}  // namespace
}  // namespace touchstone::verify::judge::ground_truth_test

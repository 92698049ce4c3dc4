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
  EXPECT_EQ(truth_about(falling, {.distance = 0.5}).toi, (DoubleInterval{0.5, 0.5}));
  const GroundTruth never = truth_about(tests::over_triangle(1, 1, 2, 1), {});
  EXPECT_FALSE(never.collides);
  EXPECT_EQ(never.toi, std::nullopt);
}

TEST(GroundTruth, InWords) {
  EXPECT_EQ(to_text(GroundTruth{.index = 0, .collides = false, .toi = std::nullopt}),
            "no collision");
  EXPECT_EQ(to_text(GroundTruth{.index = 0, .collides = true, .toi = DoubleInterval{0.5, 0.5}}),
            "collision at 0.5");
  EXPECT_EQ(to_text(GroundTruth{.index = 0, .collides = true, .toi = DoubleInterval{0.25, 0.5}}),
            "collision after 0.25 and before 0.5");
}

}  // namespace
}  // namespace touchstone::verify::judge::ground_truth_test

#include "verify/generate/offset.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace touchstone::verify::generate::offset_test {
namespace {

using exact::Rational;

Offset3 still(int x, int y, int z) { return {.start = {x, y, z}, .end = {x, y, z}}; }

constexpr Separation five_l2{.distance = 5.0, .norm = Norm::l2};
constexpr Separation five_linf{.distance = 5.0, .norm = Norm::linf};

TEST(Offset, TheNormsDiffer) {
  for (const Separation& separation : {five_l2, five_linf}) {
    const Arrival at_rest = arrival(still(3, -4, 0), separation);
    EXPECT_TRUE(at_rest.comes);
    EXPECT_EQ(at_rest.time, Rational(0));
    EXPECT_FALSE(arrival(still(0, 0, -6), separation).comes);
  }
  EXPECT_FALSE(arrival(still(5, 1, 0), five_l2).comes);
  EXPECT_TRUE(arrival(still(5, 1, 0), five_linf).comes);
}

TEST(Offset, TheTimeIsTheFirstAndExact) {
  const Offset3 falling{.start = {6, 8, 0}, .end = {0, 0, 0}};
  EXPECT_EQ(arrival(falling, five_l2).time, Rational(1, 2));
  EXPECT_EQ(arrival(falling, five_linf).time, Rational(3, 8));
  const Offset3 passing{.start = {-13, 3, 0}, .end = {13, 3, 0}};
  EXPECT_EQ(arrival(passing, five_l2).time, Rational(9, 26));
  EXPECT_EQ(arrival(passing, five_linf).time, Rational(4, 13));
  EXPECT_EQ(arrival({.start = {3, 5, 0}, .end = {3, 4, 0}}, five_l2).time, Rational(1));
}

TEST(Offset, AnIrrationalTimeIsLeftOpen) {
  const Arrival arrived = arrival({.start = {4, 6, 0}, .end = {4, 0, 1}}, five_l2);
  EXPECT_TRUE(arrived.comes);
  EXPECT_EQ(arrived.time, std::nullopt);
}

TEST(Offset, ItMustComeWithinTheTime) {
  // The line comes near enough at t = 2.
  EXPECT_FALSE(arrival({.start = {15, 0, 0}, .end = {10, 0, 0}}, five_l2).comes);
  EXPECT_FALSE(arrival({.start = {15, 0, 0}, .end = {10, 0, 0}}, five_linf).comes);
  // Each axis comes near enough, but at different times.
  EXPECT_FALSE(arrival({.start = {10, 0, 0}, .end = {0, 20, 0}}, five_linf).comes);
  // The point passes at a distance that is slightly too large.
  EXPECT_FALSE(arrival({.start = {-9, 5, 1}, .end = {9, 5, 1}}, five_l2).comes);
  EXPECT_EQ(arrival({.start = {-9, 5, 0}, .end = {9, 5, 0}}, five_l2).time, Rational(1, 2));
}

}  // namespace
}  // namespace touchstone::verify::generate::offset_test

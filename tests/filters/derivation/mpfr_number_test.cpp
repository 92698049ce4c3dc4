#include "touchstone/derivation/mpfr_number.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace touchstone::filters::mpfr_number_test {
namespace {

TEST(MpfrNumber, ComputesBeyondDoubles) {
  const MpfrNumber one(1, 200), tiny(0x1p-100, 200);
  EXPECT_EQ((one + tiny).to_double(), 1.0);
  EXPECT_EQ(((one + tiny) - one).to_double(), 0x1p-100);
  EXPECT_EQ(((one + tiny) * (one - tiny) - one).to_double(), -0x1p-200);
}

TEST(MpfrNumber, RaisesTheFlagWhereItRounds) {
  mpfr_clear_inexflag();
  const MpfrNumber one(1, 100);
  static_cast<void>(one + MpfrNumber(0x1p-99, 100));
  EXPECT_FALSE(mpfr_inexflag_p());
  static_cast<void>(one + MpfrNumber(0x1p-101, 100));
  EXPECT_TRUE(mpfr_inexflag_p());
}

TEST(MpfrNumber, HasTheGreaterPrecisionOfItsOperands) {
  const MpfrNumber sum = MpfrNumber(1, 53) + MpfrNumber(0x1p-100, 200);
  EXPECT_EQ((sum - MpfrNumber(1, 53)).to_double(), 0x1p-100);
}

TEST(MpfrNumber, IsCopiedByValue) {
  MpfrNumber a(1, 60);
  const MpfrNumber& same = a;
  const MpfrNumber b = a;
  a = MpfrNumber(2, 100);
  a = same;
  EXPECT_EQ(a.to_double(), 2.0);
  EXPECT_EQ(b.to_double(), 1.0);
}

}  // namespace
}  // namespace touchstone::filters::mpfr_number_test

#include "fast/platform/arithmetic_check.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "tests/support/floating_point_modes.hpp"
#include "tests/support/messages.hpp"

namespace touchstone::fast::arithmetic_check_test {
namespace {

TEST(ArithmeticCheck, AcceptsThisBuild) {
  EXPECT_TRUE(check_arithmetic().is_strict());
  EXPECT_NO_THROW(require_strict_arithmetic());
}

TEST(ArithmeticCheck, FindsEveryOtherRoundingModeAndSaysSo) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    EXPECT_NO_THROW(require_strict_environment());
    std::fesetround(mode);
    const ArithmeticReport report = check_arithmetic();
    EXPECT_THROW(require_strict_environment(), std::runtime_error) << mode;
    const std::string message =
        tests::message_of<std::runtime_error>([] { require_strict_arithmetic(); });
    std::fesetround(FE_TONEAREST);
    EXPECT_FALSE(report.rounds_to_nearest) << mode;
    EXPECT_TRUE(report.gradual_underflow) << mode;
    EXPECT_EQ(message,
              "touchstone: arithmetic is not strict: the rounding mode is not to nearest;");
  }
}

TEST(ArithmeticCheck, FindsFlushToZeroAndDenormalsAreZero) {
  for (const std::uint64_t flag : {tests::flush_to_zero, tests::subnormals_are_zero}) {
    const ArithmeticReport report = [flag] {
      const tests::ChangedModes changed(flag);
      EXPECT_THROW(require_strict_environment(), std::runtime_error) << flag;
      return check_arithmetic();
    }();
    EXPECT_FALSE(report.gradual_underflow) << flag;
    EXPECT_TRUE(report.rounds_to_nearest) << flag;
    EXPECT_NO_THROW(require_strict_environment());
  }
}

}  // namespace
}  // namespace touchstone::fast::arithmetic_check_test

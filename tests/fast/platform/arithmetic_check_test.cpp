#include "fast/platform/arithmetic_check.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>

#include "tests/support/floating_point_modes.hpp"

namespace touchstone::fast::arithmetic_check_test {
namespace {

/// Restores the floating-point environment that the test found.
class ArithmeticCheck : public ::testing::Test {
 public:
  ArithmeticCheck() { std::fegetenv(&environment_); }
  ArithmeticCheck(const ArithmeticCheck&) = delete;
  ArithmeticCheck& operator=(const ArithmeticCheck&) = delete;
  ArithmeticCheck(ArithmeticCheck&&) = delete;
  ArithmeticCheck& operator=(ArithmeticCheck&&) = delete;
  ~ArithmeticCheck() override { std::fesetenv(&environment_); }

 private:
  std::fenv_t environment_{};
};

TEST_F(ArithmeticCheck, AcceptsThisBuild) {
  EXPECT_TRUE(check_arithmetic().is_strict());
  EXPECT_NO_THROW(require_strict_arithmetic());
}

TEST_F(ArithmeticCheck, FindsEveryOtherRoundingMode) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const ArithmeticReport report = check_arithmetic();
    std::fesetround(FE_TONEAREST);
    EXPECT_FALSE(report.rounds_to_nearest) << mode;
    EXPECT_TRUE(report.gradual_underflow) << mode;
  }
}

TEST_F(ArithmeticCheck, FindsFlushToZeroAndDenormalsAreZero) {
  for (const std::uint64_t flag : {tests::flush_to_zero, tests::subnormals_are_zero}) {
    const ArithmeticReport report = [flag] {
      const tests::ChangedModes changed(flag);
      return check_arithmetic();
    }();
    EXPECT_FALSE(report.gradual_underflow) << flag;
    EXPECT_TRUE(report.rounds_to_nearest) << flag;
  }
}

TEST_F(ArithmeticCheck, SaysWhatIsWrong) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    try {
      require_strict_arithmetic();
      FAIL() << "another rounding mode was accepted: " << mode;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(),
                   "touchstone: arithmetic is not strict: the rounding mode is not to nearest;");
    }
  }
}

TEST_F(ArithmeticCheck, SeesTheEnvironmentChangeAfterItsFirstCall) {
  EXPECT_NO_THROW(require_strict_environment());
  for (const std::uint64_t flag : {tests::flush_to_zero, tests::subnormals_are_zero}) {
    const tests::ChangedModes changed(flag);
    EXPECT_THROW(require_strict_environment(), std::runtime_error) << flag;
  }
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    EXPECT_THROW(require_strict_environment(), std::runtime_error) << mode;
    std::fesetround(FE_TONEAREST);
  }
  EXPECT_NO_THROW(require_strict_environment());
}

}  // namespace
}  // namespace touchstone::fast::arithmetic_check_test

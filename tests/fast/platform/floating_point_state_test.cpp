#include "fast/platform/floating_point_state.hpp"

#include <gtest/gtest.h>

#include <cfenv>
#include <limits>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace touchstone::fast::floating_point_state_test {
namespace {

double opaque(double x) {
  volatile double hidden = x;
  return hidden;
}

TEST(StrictFloatingPoint, RoundsToNearestWhateverTheCallerDoes) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    std::fesetround(mode);
    {
      const StrictFloatingPoint strict;
      EXPECT_EQ(opaque(1.0) + opaque(0x1p-53), 1.0);
      EXPECT_EQ(opaque(1.0) + opaque(0x1.8p-53), 1.0 + 0x1p-52);
    }
    EXPECT_EQ(std::fegetround(), mode);
    std::fesetround(FE_TONEAREST);
  }
}

#ifdef __SSE2__
TEST(StrictFloatingPoint, KeepsSubnormalsAndTrapsNothing) {
  const unsigned before = _mm_getcsr();
  // Flush to zero, subnormals are zeros, and all exceptions trapped.
  const unsigned callers = 0x8000U | 0x0040U;
  _mm_setcsr(callers);
  {
    const StrictFloatingPoint strict;
    const double half = opaque(std::numeric_limits<double>::min()) / opaque(2.0);
    EXPECT_GT(half, 0.0);
    EXPECT_EQ(half + half, std::numeric_limits<double>::min());
    EXPECT_EQ(opaque(1.0) / opaque(0.0), std::numeric_limits<double>::infinity());
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after, callers) << "flags raised meanwhile are not the caller's";
}
#endif

}  // namespace
}  // namespace touchstone::fast::floating_point_state_test

#include "verify/baselines/upward_rounding.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace touchstone::baselines::upward_rounding_test {
namespace {

double opaque(double x) {
  volatile double hidden = x;
  return hidden;
}

TEST(UpwardRounding, RoundsUpAndGivesTheModeBack) {
  EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0);
  {
    const UpwardRounding upward;
    EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0 + 0x1p-52);
    EXPECT_EQ(opaque(-1.0) - opaque(0x1p-60), -1.0);
    {
      const UpwardRounding again;
      EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0 + 0x1p-52);
    }
    EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0 + 0x1p-52);
  }
  EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0);
}

TEST(UpwardRounding, GivesTheModeBackAfterAnException) {
  EXPECT_THROW(
      {
        const UpwardRounding upward;
        throw std::domain_error("inflection");
      },
      std::domain_error);
  EXPECT_EQ(opaque(1.0) + opaque(0x1p-60), 1.0);
}

}  // namespace
}  // namespace touchstone::baselines::upward_rounding_test

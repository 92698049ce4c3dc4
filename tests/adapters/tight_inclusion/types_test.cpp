// Types in single precision.
#define TOUCHSTONE_TICCD_FLOAT
#include "adapters/tight_inclusion/types.hpp"

#include <gtest/gtest.h>

#include <tight_inclusion/ccd.hpp>
#include <type_traits>

namespace touchstone::adapters::types_test {
namespace {

static_assert(std::is_same_v<ticcd::Scalar, float>);
#ifdef TIGHT_INCLUSION_WITH_DOUBLE_PRECISION
#error "single precision is not configured"
#endif
static_assert(std::is_same_v<ticcd::Vector3, Eigen::Vector3f>);
static_assert(std::is_same_v<ticcd::Array3, Eigen::Array3f>);

TEST(TightInclusionAdapterInFloat, RoundsTheTimeOfImpactDown) {
  const Eigen::Vector3f a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  for (int n = 1; n < 200; ++n) {
    // The height falls from 1 to -n/64: the contact is at 64 / (64 + n).
    const float end = -static_cast<float>(n) / 64.0F;
    float toi = -1.0F, tolerance = -1.0F;
    ASSERT_TRUE(ticcd::vertexFaceCCD({1, 1, 1}, a, b, c, {1, 1, end}, a, b, c, {-1, -1, -1}, 0.0F,
                                     toi, 1e-4F, 1.0F, 100, tolerance));
    EXPECT_LT(static_cast<double>(toi) * (64 + n), 64.0) << "exact: 24 bits times 9";
    EXPECT_NEAR(static_cast<double>(toi), 64.0 / (64 + n), 1e-6);
    EXPECT_EQ(tolerance, 1e-4F);
  }
}

}  // namespace
}  // namespace touchstone::adapters::types_test

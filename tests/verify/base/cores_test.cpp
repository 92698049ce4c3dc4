#include "verify/base/cores.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::base::cores_test {
namespace {

TEST(Cores, AreThoseAskedForWithinReason) {
  EXPECT_EQ(cores_for(3), 3);
  EXPECT_EQ(cores_for(1'000'000), 1024);
  EXPECT_EQ(cores_for(0), oneapi::tbb::info::default_concurrency());
}

}  // namespace
}  // namespace touchstone::verify::base::cores_test

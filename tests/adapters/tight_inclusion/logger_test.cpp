#include "tight_inclusion/logger.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <tight_inclusion/logger.hpp>

namespace touchstone::adapters::logger_test {
namespace {

TEST(TightInclusionLogger, IsOfItsNameUntilAnotherIsSet) {
  EXPECT_EQ(ticcd::logger().name(), "ticcd");
  EXPECT_NE(&ticcd::logger(), spdlog::default_logger().get());
  const auto other = std::make_shared<spdlog::logger>("other");
  ticcd::set_logger(other);
  EXPECT_EQ(&ticcd::logger(), other.get());
}

}  // namespace
}  // namespace touchstone::adapters::logger_test

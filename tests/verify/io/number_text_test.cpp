#include "verify/io/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace touchstone::verify::io::number_text_test {
namespace {

TEST(NumberFromText, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(number_from_text<std::uint64_t>("18446744073709551615"),
            std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(number_from_text<int>("-7"), -7);
  EXPECT_EQ(number_from_text<double>("-1.5e3"), -1500.0);
  EXPECT_TRUE(std::isnan(number_from_text<double>("nan").value()));
  for (const char* text : {"", " 1", "1 ", "+1", "1.5", "0x1", "18446744073709551616", "-1"}) {
    EXPECT_FALSE(number_from_text<std::uint64_t>(text).has_value()) << text;
  }
  for (const char* text : {"", "1e", "1,5", "1e999", "0x1p0"}) {
    EXPECT_FALSE(number_from_text<double>(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace touchstone::verify::io::number_text_test

#include "verify/io/words.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io::words_test {
namespace {

std::vector<std::string> words(std::string_view line) {
  std::vector<std::string> result;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
    result.emplace_back(word);
  }
  EXPECT_TRUE(line.empty());
  return result;
}

TEST(TakeWord, SplitsAtBlanks) {
  EXPECT_EQ(words("v 1  2\t3"), (std::vector<std::string>{"v", "1", "2", "3"}));
  EXPECT_EQ(words(" \tf 1/2"), (std::vector<std::string>{"f", "1/2"}));
  EXPECT_EQ(words(""), std::vector<std::string>{});
  EXPECT_EQ(words(" \t "), std::vector<std::string>{});
}

TEST(TakeWord, LeavesTheRest) {
  std::string_view line = " one two ";
  EXPECT_EQ(take_word(line), "one");
  EXPECT_EQ(line, " two ");
}

TEST(ParseNumber, IsExactAndInRange) {
  EXPECT_EQ(parse_number<double>("0.1"), 0.1);
  EXPECT_EQ(parse_number<double>("+1.5e-3"), 1.5e-3);
  EXPECT_EQ(parse_number<double>("5e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_number<float>("0.1"), 0.1F);
  EXPECT_EQ(parse_number<std::int32_t>("-2147483648"), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(parse_number<std::uint8_t>("255"), std::uint8_t{255});
  EXPECT_TRUE(std::isnan(parse_number<double>("nan").value()));
  EXPECT_TRUE(std::isinf(parse_number<double>("-inf").value()));
}

TEST(ParseNumber, RefusesAllElse) {
  for (const std::string_view text :
       {"", "+", "-", "++1", "+-1", "1x", " 1", "1 ", "0x10", "1e400", "one", "1,5"}) {
    EXPECT_FALSE(parse_number<double>(text)) << text;
    EXPECT_FALSE(parse_number<std::int32_t>(text)) << text;
  }
  EXPECT_FALSE(parse_number<std::int32_t>("1.0"));
  EXPECT_FALSE(parse_number<std::int32_t>("2147483648"));
  EXPECT_FALSE(parse_number<std::uint8_t>("256"));
  EXPECT_FALSE(parse_number<std::uint8_t>("-1"));
  EXPECT_FALSE(parse_number<float>("1e39"));
}

}  // namespace
}  // namespace touchstone::verify::io::words_test

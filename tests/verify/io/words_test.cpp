#include "verify/io/words.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace touchstone::verify::io::words_test

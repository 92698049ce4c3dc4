#include "verify/dataset/dataset_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace touchstone::verify {
namespace {

TEST(DatasetError, says_path_line_column_and_reason_without_the_parts_that_are_zero) {
  EXPECT_STREQ(DatasetError("a/b.csv", {.line = 12, .column = 3}, "bad").what(),
               "a/b.csv:12:3: bad");
  EXPECT_STREQ(DatasetError("a/b.csv", {.line = 12}, "bad").what(), "a/b.csv:12: bad");
  EXPECT_STREQ(DatasetError("a/b.csv", {}, "bad").what(), "a/b.csv: bad");
}

TEST(DatasetError, keeps_its_parts) {
  const DatasetError error("a/b.csv", {.line = 12, .column = 3}, "bad");
  EXPECT_EQ(error.path(), "a/b.csv");
  EXPECT_EQ(error.line(), 12U);
  EXPECT_EQ(error.column(), 3U);
  EXPECT_EQ(error.reason(), "bad");
}

TEST(Quote, cuts_long_text_and_hides_what_a_terminal_would_obey) {
  EXPECT_EQ(quote("1.5"), "\"1.5\"");
  EXPECT_EQ(quote(std::string_view("a\x1b[31m\0\n", 7)), "\"a?[31m?\"");
  EXPECT_EQ(quote("\xc3\xa9"), "\"??\"");
  EXPECT_EQ(quote(std::string(40, 'x')), "\"" + std::string(40, 'x') + "\"");
  EXPECT_EQ(quote(std::string(41, 'x')), "\"" + std::string(40, 'x') + "...\"");
}

}  // namespace
}  // namespace touchstone::verify

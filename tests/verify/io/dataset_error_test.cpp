#include "verify/io/dataset_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace touchstone::verify::io::dataset_error_test {
namespace {

TEST(DatasetError, SaysPathLineColumnAndReasonWithoutThePartsThatAreZero) {
  EXPECT_STREQ(DatasetError("a/b.csv", {.line = 12, .column = 3}, "bad").what(),
               "a/b.csv:12:3: bad");
  EXPECT_STREQ(DatasetError("a/b.csv", {.line = 12}, "bad").what(), "a/b.csv:12: bad");
  EXPECT_STREQ(DatasetError("a/b.csv", {}, "bad").what(), "a/b.csv: bad");
}

TEST(DatasetError, HasABoundedLength) {
  const DatasetError error(std::string(100000, 'p'), {.line = 12, .column = 3},
                           std::string(100000, 'r'));
  EXPECT_EQ(error.what(), std::string(4096, 'p') + "...:12:3: " + std::string(1000, 'r') + "...");
  EXPECT_EQ(error.reason(), std::string(1000, 'r') + "...");
  EXPECT_EQ(error.path().string().size(), 100000U) << "only what is printed is cut";
  EXPECT_EQ(DatasetError("p", {}, std::string(1000, 'r')).reason(), std::string(1000, 'r'));
  EXPECT_EQ(DatasetError("p", {}, std::string(999, 'r') + "\xF0\x9F\x98\x80").reason(),
            std::string(999, 'r') + "...")
      << "no character is cut in two";
}

TEST(Beginning, TakesWholeCharacters) {
  EXPECT_EQ(beginning("abc", 3), "abc");
  EXPECT_EQ(beginning("abc", 2), "ab");
  EXPECT_EQ(beginning("", 0), "");
  EXPECT_EQ(beginning("a\xC3\xA9", 2), "a");
  EXPECT_EQ(beginning("a\xC3\xA9", 3), "a\xC3\xA9");
  EXPECT_EQ(beginning("\xF0\x9F\x98\x80", 3), "");
  EXPECT_EQ(beginning(std::string(10, '\x80'), 5).size(), 2U) << "where it is not UTF-8 it ends";
}

TEST(Quote, CutsLongTextAndHidesWhatATerminalWouldObey) {
  EXPECT_EQ(quote("1.5"), "\"1.5\"");
  EXPECT_EQ(quote(std::string_view("a\x1b[31m\0\n", 7)), "\"a?[31m?\"");
  EXPECT_EQ(quote("\xc3\xa9"), "\"??\"");
  EXPECT_EQ(quote(std::string(40, 'x')), "\"" + std::string(40, 'x') + "\"");
  EXPECT_EQ(quote(std::string(41, 'x')), "\"" + std::string(40, 'x') + "...\"");
}

}  // namespace
}  // namespace touchstone::verify::io::dataset_error_test

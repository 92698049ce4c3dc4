#include "verify/report/tables.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::tables_test {
namespace {

using Row = std::vector<std::string>;

TEST(Tables, NumbersAreShort) {
  EXPECT_EQ(short_number(0.0), "0");
  EXPECT_EQ(short_number(0.0123456), "0.0123");
  EXPECT_EQ(short_number(12.345), "12.3");
  EXPECT_EQ(short_number(124242.4), "124242");
  EXPECT_EQ(short_number(1e-100), "1e-100");
  EXPECT_EQ(short_number(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(Tables, HavePercentOfTwoDigits) {
  EXPECT_EQ(percent(0.0000123), "0.0012 %");
  EXPECT_EQ(percent(0.083), "8.3 %");
  EXPECT_EQ(percent(0.994), "99 %");
  EXPECT_EQ(percent(0.996), "100 %");
  EXPECT_EQ(percent(1.0), "100 %");
}

TEST(Tables, WriteMarkdownAndCsv) {
  const Table table{.title = "t", .columns = {"a", "b|c"}, .rows = {{"1", "x, \"y\""}}};
  EXPECT_EQ(to_markdown(table), "| a | b\\|c |\n| --- | --- |\n| 1 | x, \"y\" |\n");
  const Table hostile{.title = "t", .columns = {"a"}, .rows = {{"=1+1\n| x | **y** <b> \u202e"}}};
  EXPECT_EQ(
      to_markdown(hostile),
      "| a |\n| --- |\n| =1+1\\\\x0a\\| x \\| \\*\\*y\\*\\* \\<b\\> \\\\xe2\\\\x80\\\\xae |\n");
  EXPECT_EQ(to_csv(hostile), "a\r\n'=1+1\\x0a| x | **y** <b> \\xe2\\x80\\xae\r\n");
  EXPECT_EQ(to_csv(table), "a,b|c\r\n1,\"x, \"\"y\"\"\"\r\n");
}

}  // namespace
}  // namespace touchstone::verify::report::tables_test

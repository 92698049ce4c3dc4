#include "verify/report/tables.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::report::tables_test {
namespace {

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

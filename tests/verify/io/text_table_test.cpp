#include "verify/io/text_table.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::io::text_table_test {
namespace {

TEST(TextTable, AlignsWordsToTheLeftAndNumbersToTheRight) {
  TextTable table({word_column("name"), {"count", 7}, {"ns"}});
  table.add({"a", "1", "2.5"});
  table.add({"longer", "12345678", "-"});
  EXPECT_EQ(table.text(),
            "name       count   ns\n"
            "a              1  2.5\n"
            "longer  12345678    -\n");
}

TEST(TextTable, CountsCharactersAndNotBytes) {
  TextTable table({word_column("µs"), {"é…"}, word_column("x")});
  table.add({"a", "b", "c"});
  table.add({"字", "b", "c"});
  EXPECT_EQ(table.text(), "µs  é…  x\na    b  c\n字   b  c\n");
}

TEST(TextTable, HasLinesAcrossItsColumns) {
  TextTable table({word_column("a"), {"b"}});
  table.add({"1", "2"});
  table.add_line("  a long line");
  table.add({"3", "4"});
  EXPECT_EQ(table.text(), "a  b\n1  2\n  a long line\n3  4\n");
}

}  // namespace
}  // namespace touchstone::verify::io::text_table_test

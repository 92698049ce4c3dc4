#include "verify/io/csv.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::verify::io::csv_test {
namespace {

using Fault = CsvSplit::Fault;

/// The fields of a record that has no more than four.
std::vector<std::string> fields_of(std::string_view record) {
  std::array<std::string, 4> fields{"old", "old", "old", "old"};
  const CsvSplit split = split_csv(record, fields);
  EXPECT_EQ(split.fault, Fault::none) << record;
  EXPECT_LE(split.count, fields.size()) << record;
  return {fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(split.count)};
}

using Fields = std::vector<std::string>;

/// Quoted where it must be, printable, and no formula.
TEST(CsvField, IsOneFieldOfPrintableText) {
  const std::vector<std::pair<std::string, std::string>> fields{
      {"a b.csv", "a b.csv"},
      {"", ""},
      {"a,b", "\"a,b\""},
      {"a\"b", "\"a\"\"b\""},
      {"a\nb", "a\\x0ab"},
      {"a\r,b", "\"a\\x0d,b\""},
      {"\x1b[31m", "\\x1b[31m"},
      {"caf\xe9", "caf\\xe9"},
      {"\u202eabc", "\\xe2\\x80\\xaeabc"},
      {"=1+1", "'=1+1"},
      {"+x", "'+x"},
      {"-x", "'-x"},
      {"@SUM(A1)", "'@SUM(A1)"},
      {"=HYPERLINK(\"a\",1)", "\"'=HYPERLINK(\"\"a\"\",1)\""},
      {"'=1", "''=1"},
      {"'a", "'a"}};
  for (const auto& [text, field] : fields) EXPECT_EQ(csv_field(text), field);
  for (const std::string number : {"-1", "+1.5", "-1e-300", "-inf", "-"}) {
    EXPECT_EQ(csv_field(number), number);
  }
}

TEST(CsvRow, JoinsFields) { EXPECT_EQ(csv_row({"a", "b,c", "", "=1"}), "a,\"b,c\",,'=1\n"); }

TEST(CsvNumber, GivesTheSameDoubleAgain) {
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number(0.10000000000000002), "0.10000000000000002");
  EXPECT_EQ(csv_number(std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(TextOfField, IsWhatTheFieldWasMadeOf) {
  for (const std::string text :
       {"a b", "=1+1", "'=1+1", "''-x", "'a", "-1", "-x", "a'=b", "", "'"}) {
    const std::string field = csv_field(text);
    EXPECT_EQ(text_of_field(field), text);
  }
  EXPECT_EQ(text_of_field(csv_field("a\nb")), "a\\x0ab");
  EXPECT_EQ(text_of_field("a\nb"), "a\\x0ab") << "as others write it";
  EXPECT_EQ(text_of_field("=1+1"), "=1+1") << "as others write it";
}

TEST(SplitCsv, SplitsAtCommasAndTakesQuotesOff) {
  const std::vector<std::pair<std::string, Fields>> records{
      {"a,b,c", {"a", "b", "c"}},
      {"a", {"a"}},
      {"", {""}},
      {",", {"", ""}},
      {"a,,b,", {"a", "", "b", ""}},
      {" a ,\tb", {" a ", "\tb"}},
      {"\"a,b\",c", {"a,b", "c"}},
      {"\"\",c", {"", "c"}},
      {"\"\"\"\",c", {"\"", "c"}},
      {"c,\"a\"\"b\"", {"c", "a\"b"}},
      {"\"a\nb\",c", {"a\nb", "c"}},
      {"a\"b,\"c\"", {"a\"b", "c"}},
  };
  for (const auto& [record, fields] : records) EXPECT_EQ(fields_of(record), fields) << record;
}

TEST(SplitCsv, CountsFieldsBeyondThoseAskedFor) {
  std::array<std::string, 2> fields;
  EXPECT_EQ(split_csv("a,b,c,\"d,e\"", fields).count, 4U);
  EXPECT_EQ(fields, (std::array<std::string, 2>{"a", "b"}));
}

TEST(SplitCsv, NamesTheFieldAtFault) {
  std::array<std::string, 4> fields;
  for (const std::string_view record : {"a,\"b", "a,\"b,c\n", "a,\"", R"(a,"b"")", R"(a,""")"}) {
    const CsvSplit split = split_csv(record, fields);
    EXPECT_EQ(split.fault, Fault::open_quote) << record;
    EXPECT_EQ(split.count, 2U) << record;
  }
  for (const std::string_view record : {"a,\"b\"c", "a,\"b\" ,c", R"(a,""b")"}) {
    const CsvSplit split = split_csv(record, fields);
    EXPECT_EQ(split.fault, Fault::text_after_quote) << record;
    EXPECT_EQ(split.count, 2U) << record;
  }
}

TEST(SplitCsv, UndoesTheQuotesOfCsvField) {
  for (const std::string_view text : {"", "a", " ", ",", "\"", "\"\"", ",\"", "\",\"", "é,ü"}) {
    EXPECT_EQ(fields_of(csv_field(text) + "," + csv_field(text)),
              (Fields{std::string(text), std::string(text)}));
  }
}

}  // namespace
}  // namespace touchstone::verify::io::csv_test

// Texts for people: printable.hpp, dataset_error.hpp, html.hpp.

#include "verify/io/printable.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/html.hpp"
#include "verify/io/json.hpp"

namespace touchstone::verify::io::printable_test {
namespace {

using namespace std::string_literals;
using Fault = CsvSplit::Fault;

/// A text from outside, and what a function makes of it.
struct Row {
  std::string (*make)(std::string_view);
  std::string text, expected;
};

TEST(TextFromOutside, IsPrintableWhereverItIsWritten) {
  for (const auto& [make, text, expected] : std::vector<Row>{
           {printable,
            "µs — é 字 \xF0\x9F\x98\x80 ა ب ﷺ क्‍ष a\u00A0b ~!\"#$%&'()*+",
            "µs — é 字 \xF0\x9F\x98\x80 ა ب ﷺ क्‍ष a\u00A0b ~!\"#$%&'()*+"},
           {printable, "\x1b[31mred", "\\x1b[31mred"},
           {printable, "a\nb\rc\td\x7f", "a\\x0ab\\x0dc\\x09d\\x7f"},
           {printable, "\0"s, "\\x00"},
           {printable, "\u0085\u009b[31m", "\\xc2\\x85\\xc2\\x9b[31m"},
           {printable, "\u061c\u200e\u200f", "\\xd8\\x9c\\xe2\\x80\\x8e\\xe2\\x80\\x8f"},
           {printable, "\u2028a\u202e", "\\xe2\\x80\\xa8a\\xe2\\x80\\xae"},
           {printable, "\u2066b\u2069", "\\xe2\\x81\\xa6b\\xe2\\x81\\xa9"},
           {printable, "caf\xE9", "caf\\xe9"},
           {printable, "\xC0\xAF\xED\xA0\x80", "\\xc0\\xaf\\xed\\xa0\\x80"},
           {printable, "\xE0\x80\xAF\xF4\x90\x80\x80", "\\xe0\\x80\\xaf\\xf4\\x90\\x80\\x80"},
           {printable, "\xE5\xAD", "\\xe5\\xad"},
           {html_escaped, "a<b>&\"'\x1b\n\u202e",
            "a&lt;b&gt;&amp;&quot;&#39;\\x1b\\x0a\\xe2\\x80\\xae"},
           {shell_word, "a/b-c.so", "a/b-c.so"},
           {shell_word, "", "''"},
           {shell_word, "it's $HOME", "'it'\\''s $HOME'"},
           {shell_word, "\x1b\n'\\1\u202e", "'\\x1b\\x0a'\\''\\1\\xe2\\x80\\xae'"},
           {quote, "a\x1b[31m\0\n"s, "\"a?[31m??\""},
           {quote, "\xc3\xa9", "\"??\""},
           {quote, std::string(41, 'x'), "\"" + std::string(40, 'x') + "...\""},
           {csv_field, "a b.csv", "a b.csv"},
           {csv_field, "a\"b", "\"a\"\"b\""},
           {csv_field, "a\r,b", "\"a\\x0d,b\""},
           {csv_field, "=1+1", "'=1+1"},
           {csv_field, "+x", "'+x"},
           {csv_field, "-x", "'-x"},
           {csv_field, "@SUM(A1)", "'@SUM(A1)"},
           {csv_field, "=HYPERLINK(\"a\",1)", "\"'=HYPERLINK(\"\"a\"\",1)\""},
           {csv_field, "'=1", "''=1"},
           {csv_field, "'a", "'a"},
           {csv_field, "-1e-300", "-1e-300"},
           {csv_field, "-", "-"}}) {
    EXPECT_EQ(make(text), expected);
    EXPECT_TRUE(is_printable(expected)) << expected;
  }
}

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
  EXPECT_EQ(DatasetError("p", {}, std::string(1000, 'r')).reason(), std::string(1000, 'r'));
  EXPECT_EQ(DatasetError("p", {}, std::string(999, 'r') + "\xF0\x9F\x98\x80").reason(),
            std::string(999, 'r') + "...")
      << "no character is cut in two";
}

TEST(Html, JsonDoesNotEndItsElementAndIsUtf8) {
  EXPECT_EQ(
      json_element("data", "</script>\xff"),
      "<script type=\"application/json\" id=\"data\">\"\\u003c/script>\xef\xbf\xbd\"</script>\n");
  EXPECT_EQ(base64(std::as_bytes(std::span("foob", 4))), "Zm9vYg==");
}

// ---- CSV ----------------------------------------------------------------------------------------

/// The fields of a record that has no more than four, or its fault and the number of its field.
std::string split(std::string_view record) {
  std::array<std::string, 4> fields{"old", "old", "old", "old"};
  const CsvSplit split = split_csv(record, fields);
  if (split.fault == Fault::open_quote) return "open " + std::to_string(split.count);
  if (split.fault == Fault::text_after_quote) return "after " + std::to_string(split.count);
  std::string text;
  for (std::size_t i = 0; i < split.count; ++i) text += "[" + fields.at(i) + "]";
  return text;
}

TEST(CsvRow, JoinsFieldsAndGivesTheSameDoubleAgain) {
  EXPECT_EQ(csv_row({"a", "b,c", csv_number(std::nan("")), "=1"}), "a,\"b,c\",,'=1\n");
  EXPECT_EQ(csv_number(0.10000000000000002), "0.10000000000000002");
}

TEST(TextOfField, IsWhatTheFieldWasMadeOf) {
  for (const std::string text : {"a b", "=1+1", "'=1+1", "''-x", "'a", "-1", "a'=b", "", "'"}) {
    EXPECT_EQ(text_of_field(csv_field(text)), text);
  }
  EXPECT_EQ(text_of_field("a\nb"), "a\\x0ab") << "as others write it";
}

TEST(SplitCsv, GivesTheFieldsOrTheFaultOfARecord) {
  for (const auto& [record, expected] :
       std::vector<std::pair<std::string_view, std::string>>{{"a,b,c", "[a][b][c]"},
                                                             {"a", "[a]"},
                                                             {"", "[]"},
                                                             {",", "[][]"},
                                                             {"a,,b,", "[a][][b][]"},
                                                             {" a ,\tb", "[ a ][\tb]"},
                                                             {"\"a,b\",c", "[a,b][c]"},
                                                             {"\"\",c", "[][c]"},
                                                             {"\"\"\"\",c", "[\"][c]"},
                                                             {"c,\"a\"\"b\"", "[c][a\"b]"},
                                                             {"\"a\nb\",c", "[a\nb][c]"},
                                                             {"a\"b,\"c\"", "[a\"b][c]"},
                                                             {"a,\"b", "open 2"},
                                                             {"a,\"b,c\n", "open 2"},
                                                             {R"(a,"b"")", "open 2"},
                                                             {"a,\"b\"c", "after 2"},
                                                             {"a,\"b\" ,c", "after 2"},
                                                             {R"(a,""b")", "after 2"}}) {
    EXPECT_EQ(split(record), expected) << record;
  }
  std::array<std::string, 2> fields;
  EXPECT_EQ(split_csv("a,b,c,\"d,e\"", fields).count, 4U) << "those beyond count too";
  EXPECT_EQ(fields, (std::array<std::string, 2>{"a", "b"}));
}

// ---- JSON ---------------------------------------------------------------------------------------

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Json, HasWordsForInfiniteNumbersAndNullForMissingOnes) {
  EXPECT_EQ(number_to_json(infinity), "Infinity");
  EXPECT_EQ(number_to_json(-infinity), "-Infinity");
  EXPECT_TRUE(number_to_json(nan).is_null());
  EXPECT_TRUE(number_to_json(std::nullopt).is_null());
  for (const double number : {0.1, -4.9e-324, infinity, -infinity}) {
    EXPECT_EQ(number_from_json(number_to_json(number)), number);
  }
  EXPECT_TRUE(std::isnan(number_from_json(number_to_json(nan))));
  EXPECT_THROW(static_cast<void>(number_from_json("infinite")), nlohmann::json::exception);
}

/// The error of reading a file with this text; empty if there is none.
std::string json_error(const std::string& text, std::size_t most_bytes = 1U << 20U) {
  const tests::TemporaryFolder folder;
  const std::string error = data::test::error_of(folder.path(), [&] {
    static_cast<void>(read_json(folder.file("a.json", text), most_bytes));
  });
  return error == "no DatasetError" ? "" : error;
}

TEST(JsonFile, IsReadUpToADepthAndASize) {
  const auto nested = [](std::string_view opening, std::string_view closing, int depth) {
    std::string text = "1";
    for (int i = 0; i < depth; ++i) text = text + std::string(closing);
    for (int i = 0; i < depth; ++i) text.insert(0, opening);
    return text;
  };
  EXPECT_EQ(json_error(nested("[", "]", deepest_json)), "");
  EXPECT_EQ(json_error(nested("[", "]", deepest_json + 1)), "a.json: nested more than 100 deep");
  EXPECT_EQ(json_error(nested(R"({"a":)", "}", 20'000)), "a.json: nested more than 100 deep");
  EXPECT_EQ(json_error("[1, 2]", 5), "a.json: has more than 5 bytes");
  EXPECT_TRUE(json_error("[1, 2").starts_with("a.json: no JSON: "));
}

TEST(JsonFile, WithAKeyTwiceOrANumberBeyondTheRangeIsAnError) {
  EXPECT_EQ(json_error(R"({"a": 1, "b": {"a": 1, "c": [{"a": 1}, {"a": 2}]}})"), "");
  EXPECT_EQ(json_error(R"({"b": {"c": [{"a": 1, "a": 1}]}})"), "a.json: repeated key \"a\"");
  EXPECT_TRUE(json_error("[-1e999]").starts_with("a.json: a number beyond the range: "));
  EXPECT_EQ(json_error("\xEF\xBB\xBF{}"), "");
}

TEST(Json, DocumentsAreAscii) {
  EXPECT_EQ(json_document({{"a", "\u202e\x1b"}}), "{\n  \"a\": \"\\u202e\\u001b\"\n}\n");
  EXPECT_EQ(json_document("caf\xe9"), "\"caf\\ufffd\"\n");
}

}  // namespace
}  // namespace touchstone::verify::io::printable_test

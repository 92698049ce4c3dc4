// Texts for people: printable.hpp, dataset_error.hpp, html.hpp.

#include "verify/io/printable.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "verify/io/dataset_error.hpp"
#include "verify/io/html.hpp"

namespace touchstone::verify::io::printable_test {
namespace {

using namespace std::string_literals;

TEST(Printable, KeepsTextInAnyLanguage) {
  for (const std::string_view text : {"", "a b", "µs — é 字 \xF0\x9F\x98\x80", "ა ب ﷺ",
                                      "क्‍ष", "\\x1b", "a\u00A0b", "~!\"#$%&'()*+"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(is_printable(text)) << text;
  }
}

TEST(Printable, WritesOutWhatActsOnATerminalOrIsNoText) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"\x1b[31mred", "\\x1b[31mred"},
      {"a\nb\rc\td", "a\\x0ab\\x0dc\\x09d"},
      {"\0"s, "\\x00"},
      {"\x7f", "\\x7f"},
      {"\u0085\u009b[31m", "\\xc2\\x85\\xc2\\x9b[31m"},
      {"\u061c\u200e\u200f", "\\xd8\\x9c\\xe2\\x80\\x8e\\xe2\\x80\\x8f"},
      {"\u2028a\u202e", "\\xe2\\x80\\xa8a\\xe2\\x80\\xae"},
      {"\u2066b\u2069", "\\xe2\\x81\\xa6b\\xe2\\x81\\xa9"},
      {"caf\xE9", "caf\\xe9"},
      {"\xC0\xAF\xED\xA0\x80", "\\xc0\\xaf\\xed\\xa0\\x80"},
      {"\xE0\x80\xAF\xF4\x90\x80\x80", "\\xe0\\x80\\xaf\\xf4\\x90\\x80\\x80"},
      {"\xE5\xAD", "\\xe5\\xad"},
      {"\x9b", "\\x9b"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(printable(text), expected);
    EXPECT_FALSE(is_printable(text)) << expected;
    EXPECT_TRUE(is_printable(expected)) << expected;
  }
}

TEST(Printable, ChangesNothingTwice) {
  std::string text;
  for (int byte = 0; byte < 256; ++byte) text += static_cast<char>(byte);
  for (int byte = 0; byte < 256; ++byte) (text += "\xE2\x80") += static_cast<char>(byte);
  EXPECT_TRUE(is_printable(printable(text)));
  EXPECT_EQ(printable(printable(text)), printable(text));
}

TEST(HtmlEscaped, LeavesNoMarkup) {
  EXPECT_EQ(html_escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(html_escaped(""), "");
  EXPECT_EQ(html_escaped("a\x1b\n<\u202e"), "a\\x1b\\x0a&lt;\\xe2\\x80\\xae");
  EXPECT_EQ(html_escaped("2⁻⁵⁰ µs — é 字"), "2⁻⁵⁰ µs — é 字");
}

TEST(ShellWord, IsOnePrintableWord) {
  EXPECT_EQ(shell_word("a/b-c.so"), "a/b-c.so");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word("\x1b[2J\n'\\1\u202e"), "'\\x1b[2J\\x0a'\\''\\1\\xe2\\x80\\xae'");
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

TEST(Html, ThePolicyLetsNothingBeLoaded) {
  const std::string page = html_beginning("A title", "p { margin: 0; }\n");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">\n"));
  EXPECT_NE(page.find("content=\"default-src 'none'; script-src 'unsafe-inline'; style-src "
                      "'unsafe-inline'; img-src data:\""),
            std::string::npos);
  EXPECT_NE(page.find("<title>A title</title>\n<style>\np { margin: 0; }\n</style>"),
            std::string::npos);
  EXPECT_TRUE(page.ends_with("<body>\n"));
}

TEST(Html, JsonDoesNotEndItsElement) {
  EXPECT_EQ(json_element("data", {{"name", "</script><b>"}}),
            "<script type=\"application/json\" id=\"data\">"
            "{\"name\":\"\\u003c/script>\\u003cb>\"}</script>\n");
  EXPECT_EQ(json_element("data", "\xff"),
            "<script type=\"application/json\" id=\"data\">\"\xef\xbf\xbd\"</script>\n");
}

TEST(Html, BytesInBase64) {
  const auto encoded = [](std::string_view text) {
    return base64(std::as_bytes(std::span(text.data(), text.size())));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("\xff\xfe\xfb"), "//77");
}

}  // namespace
}  // namespace touchstone::verify::io::printable_test

#include "verify/io/printable.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

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

}  // namespace
}  // namespace touchstone::verify::io::printable_test

#include "verify/io/printable.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io::printable_test {
namespace {

using namespace std::string_literals;

TEST(FirstCharacter, IsOfWellFormedUtf8Only) {
  const auto is = [](std::string_view text, std::size_t length, char32_t code) {
    const Character character = first_character(text);
    return character.length == length && character.code == code;
  };
  EXPECT_TRUE(is("ab", 1, U'a'));
  EXPECT_TRUE(is("\xC3\xA9x", 2, 0xE9));
  EXPECT_TRUE(is("\xE5\xAD\x97", 3, 0x5B57));
  EXPECT_TRUE(is("\xF0\x9F\x98\x80", 4, 0x1F600));
  EXPECT_TRUE(is("\0"s, 1, 0));
  for (const std::string_view ill :
       {"", "\x80", "\xC3", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80",
        "\xF8\x88\x80\x80\x80", "\xE5\xAD", "\xFF"}) {
    EXPECT_EQ(first_character(ill).length, 0U) << ill;
  }
}

TEST(Printable, KeepsTextInAnyLanguage) {
  for (const std::string_view text : {"", "a b", "µs — é 字 \xF0\x9F\x98\x80", "ა ب ﷺ",
                                      "क्‍ष", "\\x1b", "a\u00A0b", "~!\"#$%&'()*+"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_TRUE(is_printable(text)) << text;
  }
}

TEST(Printable, WritesOutWhatActsOnATerminalOrIsNotSeen) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"\x1b[31mred", "\\x1b[31mred"},
      {"a\nb\rc\td", "a\\x0ab\\x0dc\\x09d"},
      {"\0"s, "\\x00"},
      {"\x7f", "\\x7f"},
      {"\u0085\u009b[31m", "\\u0085\\u009b[31m"},
      {"\u061c\u200b\u200e\u200f", "\\u061c\\u200b\\u200e\\u200f"},
      {"\u2028\u2029\u202a\u202b\u202c\u202d\u202e",
       "\\u2028\\u2029\\u202a\\u202b\\u202c\\u202d\\u202e"},
      {"\u2060\u2066\u2067\u2068\u2069\u206f", "\\u2060\\u2066\\u2067\\u2068\\u2069\\u206f"},
      {"\uFEFF\uFFF9\uFDD0\uFFFE\uFFFF", "\\ufeff\\ufff9\\ufdd0\\ufffe\\uffff"},
      {"\U000E0041\U0001FFFE", "\\U000e0041\\U0001fffe"},
      {"caf\xE9", "caf\\xe9"},
      {"\xC0\xAF\xED\xA0\x80", "\\xc0\\xaf\\xed\\xa0\\x80"},
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

TEST(MarkdownEscaped, LeavesNoMarkup) {
  EXPECT_EQ(markdown_escaped("a|b"), "a\\|b");
  EXPECT_EQ(markdown_escaped("<img src=x>"), "\\<img src=x\\>");
  EXPECT_EQ(markdown_escaped("[a](b)"), "\\[a\\](b)");
  EXPECT_EQ(markdown_escaped("**a** `b` ~~c~~ \\"), "\\*\\*a\\*\\* \\`b\\` \\~\\~c\\~\\~ \\\\");
  EXPECT_EQ(markdown_escaped("&lt; $x$ http://a"), "\\&lt; \\$x\\$ http\\://a");
  EXPECT_EQ(markdown_escaped("_a_"), "\\_a\\_");
  EXPECT_EQ(markdown_escaped("a\n# b"), "a\\\\x0a# b");
}

TEST(MarkdownEscaped, KeepsNamesAndNumbers) {
  for (const std::string_view text :
       {"tight_inclusion", "1.5e-08", "-1", "δ: 2⁻⁵⁰", "57,000", ""}) {
    EXPECT_EQ(markdown_escaped(text), text);
  }
}

TEST(MarkdownCode, CannotBeLeft) {
  EXPECT_EQ(markdown_code("a_b"), "`a_b`");
  EXPECT_EQ(markdown_code("a`b"), "``a`b``");
  EXPECT_EQ(markdown_code("``a"), "``` ``a ```");
  EXPECT_EQ(markdown_code("a\nb"), "`a\\x0ab`");
  EXPECT_EQ(markdown_code_block("touchstone report"), "```\ntouchstone report\n```\n");
  EXPECT_EQ(markdown_code_block("```\n````"), "`````\n```\\x0a````\n`````\n");
}

TEST(HtmlEscaped, LeavesNoMarkup) {
  EXPECT_EQ(html_escaped("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(html_escaped(""), "");
  EXPECT_EQ(html_escaped("a\x1b\n<\u202e"), "a\\x1b\\x0a&lt;\\u202e");
  EXPECT_EQ(html_escaped("2⁻⁵⁰ µs — é 字"), "2⁻⁵⁰ µs — é 字");
}

TEST(ShellWord, IsOneWordWithTheSameBytes) {
  EXPECT_EQ(shell_word("a/b-c.so"), "a/b-c.so");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word("\x1b[2J\n'\\1\u202e"), "$'\\033[2J\\012\\'\\\\1\\342\\200\\256'");
  EXPECT_EQ(shell_word("caf\xe9"), "$'caf\\351'");
}

}  // namespace
}  // namespace touchstone::verify::io::printable_test

#include "verify/io/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <iterator>

namespace touchstone::verify::io {
namespace {

/// Code points from the first to the last.
struct Range {
  char32_t first, last;
};

constexpr auto invisible = std::to_array<Range>({{0x0000, 0x001F},
                                                 {0x007F, 0x009F},
                                                 {0x061C, 0x061C},
                                                 {0x200B, 0x200B},
                                                 {0x200E, 0x200F},
                                                 {0x2028, 0x202E},
                                                 {0x2060, 0x206F},
                                                 {0xFDD0, 0xFDEF},
                                                 {0xFEFF, 0xFEFF},
                                                 {0xFFF9, 0xFFFB},
                                                 {0xE0000, 0xE007F}});

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Calls use(character, bytes) for each character, and for each byte that belongs to none.
template <class Use>
void for_each_character(std::string_view text, const Use& use) {
  while (!text.empty()) {
    const Character character = first_character(text);
    const std::size_t length = std::max<std::size_t>(character.length, 1);
    use(character, text.substr(0, length));
    text.remove_prefix(length);
  }
}

void append_written_out(std::string& text, const Character& character, std::string_view bytes) {
  const auto to = std::back_inserter(text);
  if (character.length <= 1) {
    fmt::format_to(to, "\\x{:02x}", byte_at(bytes, 0));
  } else if (character.code <= 0xFFFF) {
    fmt::format_to(to, "\\u{:04x}", static_cast<std::uint32_t>(character.code));
  } else {
    fmt::format_to(to, "\\U{:08x}", static_cast<std::uint32_t>(character.code));
  }
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// True if the character at `i` of printable text could be markup. An underscore within a word is
/// not, and a colon only in front of the slashes of an address.
bool is_markup(std::string_view text, std::size_t i) {
  static constexpr std::string_view marks = "\\`*[]<>|~&$";
  const char c = text[i];
  if (c == '_')
    return i == 0 || i + 1 == text.size() || !is_word(text[i - 1]) || !is_word(text[i + 1]);
  if (c == ':') return text.substr(i + 1).starts_with("//");
  return marks.find(c) != std::string_view::npos;
}

/// The text with its quotes and backslashes escaped, and other characters as octal bytes of three
/// digits, which C++ and shells read alike.
std::string escaped_within(char quote, std::string_view text) {
  std::string result;
  for_each_character(text, [&](const Character& character, std::string_view bytes) {
    if (!is_printable(character)) {
      for (std::size_t i = 0; i < bytes.size(); ++i) {
        fmt::format_to(std::back_inserter(result), "\\{:03o}", byte_at(bytes, i));
      }
      return;
    }
    if (bytes.front() == quote || bytes.front() == '\\') result += '\\';
    result += bytes;
  });
  return result;
}

/// The most backticks in a row.
std::size_t longest_backticks(std::string_view text) {
  std::size_t longest = 0, run = 0;
  for (const char c : text) {
    run = c == '`' ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

}  // namespace

Character first_character(std::string_view text) {
  const unsigned lead = byte_at(text, 0);
  if (text.empty()) return {};
  if (lead < 0x80) return {.length = 1, .code = lead};
  if (lead < 0xC2 || lead > 0xF4) return {};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  char32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const unsigned next = byte_at(text, i);
    if ((next & 0xC0U) != 0x80U) return {};
    code = code << 6U | (next & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (overlong || surrogate || code > 0x10FFFF) return {};
  return {.length = length, .code = code};
}

bool is_printable(const Character& character) {
  const char32_t code = character.code;
  const bool is_last_of_plane = (code & 0xFFFEU) == 0xFFFEU;
  return character.length != 0 && !is_last_of_plane &&
         std::ranges::none_of(invisible, [code](const Range& range) {
           return range.first <= code && code <= range.last;
         });
}

bool is_printable(std::string_view text) {
  bool result = true;
  for_each_character(text, [&](const Character& character, std::string_view) {
    result = result && is_printable(character);
  });
  return result;
}

std::string printable(std::string_view text) {
  std::string result;
  for_each_character(text, [&](const Character& character, std::string_view bytes) {
    if (is_printable(character)) {
      result += bytes;
    } else {
      append_written_out(result, character, bytes);
    }
  });
  return result;
}

std::string markdown_escaped(std::string_view text) {
  const std::string line = printable(text);
  std::string result;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (is_markup(line, i)) result += '\\';
    result += line[i];
  }
  return result;
}

std::string markdown_code(std::string_view text) {
  const std::string line = printable(text);
  const std::string fence(longest_backticks(line) + 1, '`');
  // A backtick at an end would join the fence; one space at both ends is not shown.
  const bool is_apart = line.starts_with('`') || line.ends_with('`') || line.empty();
  const std::string_view space = is_apart ? " " : "";
  return fmt::format("{0}{1}{2}{1}{0}", fence, space, line);
}

std::string markdown_code_block(std::string_view text) {
  static constexpr std::size_t shortest = 3;
  const std::string line = printable(text);
  const std::string fence(std::max(shortest, longest_backticks(line) + 1), '`');
  return fmt::format("{0}\n{1}\n{0}\n", fence, line);
}

std::string html_escaped(std::string_view text) {
  static constexpr std::string_view marks = "&<>\"'";
  static constexpr std::array<std::string_view, marks.size()> entities{"&amp;", "&lt;", "&gt;",
                                                                       "&quot;", "&#39;"};
  std::string result;
  for (const char c : printable(text)) {
    const std::size_t mark = marks.find(c);
    result += mark == std::string_view::npos ? std::string_view(&c, 1) : entities.at(mark);
  }
  return result;
}

std::string shell_word(std::string_view text) {
  static constexpr std::string_view harmless =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,";
  if (!is_printable(text)) return "$'" + escaped_within('\'', text) + "'";
  if (!text.empty() && text.find_first_not_of(harmless) == std::string_view::npos) {
    return std::string(text);
  }
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string cpp_literal(std::string_view text) { return '"' + escaped_within('"', text) + '"'; }

}  // namespace touchstone::verify::io

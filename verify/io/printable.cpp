#include "verify/io/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace touchstone::verify::io {
namespace {

/// Code points from the first to the last.
struct Range {
  char32_t first, last;
};

constexpr auto unprintable = std::to_array<Range>({{0x0000, 0x001F},
                                                   {0x007F, 0x009F},
                                                   {0x061C, 0x061C},
                                                   {0x200E, 0x200F},
                                                   {0x2028, 0x202E},
                                                   {0x2066, 0x2069}});

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Bytes of the printable character that a text begins with; 0 if it begins with none.
std::size_t printable_length(std::string_view text) {
  const unsigned lead = byte_at(text, 0);
  if (lead >= 0x80 && (lead < 0xC2 || lead > 0xF4)) return 0;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0x80 ? 2 : 1;
  char32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const unsigned next = byte_at(text, i);
    if ((next & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (next & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  const auto contains = [code](const Range& range) {
    return range.first <= code && code <= range.last;
  };
  const bool is_character = !overlong && !surrogate && code <= 0x10FFFF;
  return is_character && std::ranges::none_of(unprintable, contains) ? length : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    if (length == 0) result += fmt::format("\\x{:02x}", byte_at(text, 0));
    result += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

bool is_printable(std::string_view text) { return printable(text) == text; }

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
  if (!text.empty() && text.find_first_not_of(harmless) == std::string_view::npos) {
    return std::string(text);
  }
  std::string result = "'";
  for (const char c : printable(text)) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

}  // namespace touchstone::verify::io

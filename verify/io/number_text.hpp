#pragma once

/// \file
/// Numbers in texts, and words between blanks in lines of meshes.

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace touchstone::verify::io {

/// The number that the whole text is; empty if it is none, is not whole for an integer type, or is
/// out of range of `Number`. Decimal, optionally with a sign and an exponent; "nan" and "inf" are
/// numbers of floating-point types.
template <class Number>
[[nodiscard]] std::optional<Number> number_from_text(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// True for a space and a tab, which separate words.
[[nodiscard]] constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Removes the next word from the front of a line; empty at its end.
[[nodiscard]] inline std::string_view take_word(std::string_view& line) {
  static constexpr std::string_view blanks = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace touchstone::verify::io

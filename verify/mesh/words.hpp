#pragma once

/// \file
/// Lines of text as the mesh formats have them: words between blanks, some of them numbers.

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace touchstone::verify::mesh {

/// Takes the next word from the front of a line; empty at its end. Words are separated by spaces,
/// tabs and carriage returns.
[[nodiscard]] std::string_view take_word(std::string_view& line);

/// The number that a text is, or nothing if it is none, is not whole where `Number` is, or is beyond
/// the range of `Number`. Decimal, also with an exponent; a '+' may stand in front; "nan" and "inf"
/// are numbers of floating-point types.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace touchstone::verify::mesh

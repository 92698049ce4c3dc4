#pragma once

/// \file
/// Lines of text in formats of meshes: words between blanks, some of them numbers.

#include <optional>
#include <string_view>

#include "verify/io/number_text.hpp"

namespace touchstone::verify::io {

/// True for a space and a tab, which separate words.
[[nodiscard]] constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Removes the next word from the front of a line; empty at its end.
[[nodiscard]] std::string_view take_word(std::string_view& line);

/// The number of a text; empty if it is none, is not whole for an integer type, or is out of range
/// of `Number`. Decimal, optionally with an exponent and a leading '+'; "nan" and "inf" are numbers
/// of floating-point types.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return number_from_text<Number>(text);
}

}  // namespace touchstone::verify::io

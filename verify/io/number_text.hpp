#pragma once

/// \file
/// Numbers in texts.

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace touchstone::verify::io {

/// The number that the whole text is; empty if it is none, is not whole for an integer type, or is
/// out of range of `Number`. Decimal, optionally with an exponent and a '-', without a '+'; "nan"
/// and "inf" are numbers of floating-point types.
template <class Number>
[[nodiscard]] std::optional<Number> number_from_text(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace touchstone::verify::io

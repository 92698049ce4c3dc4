#pragma once

/// \file
/// What every page of HTML that this project writes has in common: it needs nothing else, no
/// network and no other file, and its policy (Content-Security-Policy) forbids to load anything.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// From the beginning of a page to the beginning of its body, <body> included.
/// \param title as it stands in HTML
/// \param style the rules of its style sheet
/// \param has_webassembly the policy allows the page's own scripts to compile WebAssembly, in workers
[[nodiscard]] std::string html_beginning(std::string_view title, std::string_view style,
                                         bool has_webassembly = false);

/// A script element of that text, with an id one that does not run, for workers; or an element of
/// JSON with an id, as a script reads it. In JSON
/// no "<" ends the element, and what is no UTF-8 becomes U+FFFD.
/// \pre the text of a script holds no "</script"
[[nodiscard]] std::string script_element(std::string_view script, std::string_view id = {});
[[nodiscard]] std::string json_element(std::string_view id, const nlohmann::json& json);

/// Bytes in base 64, with padding (RFC 4648).
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace touchstone::verify::io

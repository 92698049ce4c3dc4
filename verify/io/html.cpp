#include "verify/io/html.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

namespace touchstone::verify::io {
namespace {

/// Nothing may be loaded from anywhere. (WebAssembly and its workers are in the page, as addresses
/// of data.)
constexpr std::string_view policy =
    "default-src 'none'; script-src 'unsafe-inline'{}; style-src 'unsafe-inline'; img-src data:";

}  // namespace

std::string html_beginning(std::string_view title, std::string_view style, bool has_webassembly) {
  const std::string allowed = fmt::format(
      policy, has_webassembly ? " 'wasm-unsafe-eval'; worker-src blob:; connect-src data:" : "");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
      allowed, title, style);
}

std::string script_element(std::string_view script, std::string_view id) {
  const std::string kept = id.empty() ? "" : fmt::format(R"( type="text/plain" id="{}")", id);
  return fmt::format("<script{}>\n{}</script>\n", kept, script);
}

std::string json_element(std::string_view id, const nlohmann::json& json) {
  std::string text = fmt::format(R"(<script type="application/json" id="{}">)", id);
  for (const char c : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text + "</script>\n";
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i]) : 0U;
  };
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += digits[three >> shift & 63U];
    for (std::size_t k = bytes.size(); k < i + 3; ++k) text[text.size() + k - i - 3] = '=';
  }
  return text;
}

}  // namespace touchstone::verify::io

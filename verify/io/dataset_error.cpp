#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::io {
namespace {

/// The text, or its beginning and "...".
std::string bounded(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  return std::string(beginning(text, longest)) + "...";
}

std::string message(const std::filesystem::path& path, FilePosition position,
                    const std::string& reason) {
  std::string text = bounded(path.string(), DatasetError::longest_path);
  if (position.line != 0) text += ":" + std::to_string(position.line);
  if (position.column != 0) text += ":" + std::to_string(position.column);
  return text + ": " + reason;
}

}  // namespace

DatasetError::DatasetError(const std::filesystem::path& path, FilePosition position,
                           const std::string& reason)
    : std::runtime_error(message(path, position, bounded(reason, longest_reason))),
      reason_(bounded(reason, longest_reason)) {}

std::string_view beginning(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return text;
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  std::size_t size = longest;
  while (size > 0 && longest - size < 3 && continues(text[size])) --size;
  return text.substr(0, size);
}

std::string quote(std::string_view text) {
  static constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace touchstone::verify::io

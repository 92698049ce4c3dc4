#include "verify/dataset/dataset_error.hpp"

#include <utility>

namespace touchstone::verify {
namespace {

std::string message(const std::filesystem::path& path, FilePosition position,
                    const std::string& reason) {
  std::string text = path.string();
  if (position.line != 0) text += ":" + std::to_string(position.line);
  if (position.column != 0) text += ":" + std::to_string(position.column);
  return text + ": " + reason;
}

}  // namespace

DatasetError::DatasetError(std::filesystem::path path, FilePosition position, std::string reason)
    : std::runtime_error(message(path, position, reason)),
      path_(std::move(path)),
      position_(position),
      reason_(std::move(reason)) {}

std::string quote(std::string_view text) {
  static constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace touchstone::verify

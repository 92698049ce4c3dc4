#pragma once

/// \file
/// The error of all dataset readers and writers: its place and its reason.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// A place in a file; 0 means that the error has no such part.
struct FilePosition {
  /// Counted from 1.
  std::uint64_t line = 0;
  /// Counted from 1: the field in a CSV file, the byte of the line in a JSON file.
  std::uint64_t column = 0;
};

/// Bad data, or a file that cannot be read or written: what() is "path:line:column: reason",
/// without the parts that are 0. Path and reason may be external texts, so what() has a bounded
/// length: "..." marks a truncation.
class DatasetError : public std::runtime_error {
 public:
  /// Maximum length of a reason in bytes.
  static constexpr std::size_t longest_reason = 1000;
  /// Maximum length of a path in what(), in bytes: that of the system's longest path.
  static constexpr std::size_t longest_path = 4096;

  DatasetError(const std::filesystem::path& path, FilePosition position, const std::string& reason);

  /// Not longer than longest_reason followed by "...".
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// The longest prefix of a text that has at most this number of bytes and cuts no UTF-8 character.
[[nodiscard]] std::string_view beginning(std::string_view text, std::size_t longest);

/// The text in double quotes for a message: cut after 40 bytes, unprintable bytes as '?'.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace touchstone::verify::io

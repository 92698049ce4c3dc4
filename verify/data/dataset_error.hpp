#pragma once

/// \file
/// The one error of all dataset readers and writers: where it is, and what is wrong there.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone::verify::data {

/// A place in a file; 0 means that the error has no such part.
struct FilePosition {
  /// Counted from 1.
  std::uint64_t line = 0;
  /// Counted from 1: number of the field in a CSV file, of the byte in the line of a JSON file.
  std::uint64_t column = 0;

  friend bool operator==(const FilePosition&, const FilePosition&) = default;
};

/// Bad data, or a file that cannot be read or written. what() is "path:line:column: reason",
/// without the parts that are 0. Path and reason may come from outside, so what() has a bounded
/// length: "..." ends what was cut.
class DatasetError : public std::runtime_error {
 public:
  /// Bytes that a reason may have.
  static constexpr std::size_t longest_reason = 1000;
  /// Bytes that a path may have in what(): those of the system's longest path.
  static constexpr std::size_t longest_path = 4096;

  DatasetError(std::filesystem::path path, FilePosition position, const std::string& reason);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Line counted from 1, 0 if the error belongs to no line.
  [[nodiscard]] std::uint64_t line() const { return position_.line; }
  /// Column as FilePosition counts it, 0 if the error belongs to no column.
  [[nodiscard]] std::uint64_t column() const { return position_.column; }
  /// Not longer than longest_reason and the "..." behind it.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::filesystem::path path_;
  FilePosition position_;
  std::string reason_;
};

/// The longest beginning of a text that has at most so many bytes and cuts no character of UTF-8 in
/// two.
[[nodiscard]] std::string_view beginning(std::string_view text, std::size_t longest);

/// The text in double quotes for a message: cut after 40 bytes, unprintable bytes as '?'.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace touchstone::verify::data

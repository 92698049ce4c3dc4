#pragma once

/// \file
/// Files that appear completely or not at all.
///
/// The data goes to a temporary name in the target's folder and takes the target's name when it is
/// complete; an existing file is unchanged until then. The temporary name,
/// <name>.touchstone.partial-<process>-<number> with <name> shortened to the limit of file names,
/// has a separate extension, so that a search for datasets does not find the remains of a killed
/// run.
///
/// The writer of a temporary file holds a lock (flock) on it, which ends with the process in any
/// case. A new writer in a folder removes the temporary files that are not locked.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// A file open for writing, buffered. Without close() it is discarded.
class OutputFile {
 public:
  /// Also removes temporary files of killed runs in the target's folder.
  /// \throws DatasetError if no file can be made in the target's folder.
  explicit OutputFile(std::filesystem::path path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  OutputFile(OutputFile&&) = delete;
  OutputFile& operator=(OutputFile&&) = delete;
  /// Removes the temporary file unless close() gave it the target's name.
  ~OutputFile();

  /// Appends bytes.
  /// \throws DatasetError if they cannot be written.
  void write(std::string_view bytes);

  /// Replaces bytes at an offset (in bytes from the start); they must be within the written part.
  /// \throws DatasetError if they cannot be written.
  void overwrite(std::uint64_t offset, std::string_view bytes);

  /// Writes the rest and renames the file. Must be called once, as the last call.
  /// \throws DatasetError if either fails; the target is then unchanged.
  void close() { close_as(path_); }

  /// The same with another name in the target's folder; the target is unchanged.
  void close_as(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  [[nodiscard]] bool lock() const;
  void flush();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
};

}  // namespace touchstone::verify::io

#pragma once

/// \file
/// Files that appear whole or not at all.
///
/// The data goes to a temporary name in the target's folder and takes the target's name when it is
/// complete; a file that was there before stays as it was until then. The temporary name,
/// <name>.touchstone.partial-<process>-<number> with <name> cut to what a file's name may have, has an
/// extension of its own, so that a search for datasets does not find what a killed run left.
///
/// Who writes a temporary file holds a lock (flock) on it, which ends with the process however that
/// ends. Who begins to write into a folder removes the temporary files there that nobody holds.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// A file open for writing, buffered. Without close() nothing remains of it.
class OutputFile {
 public:
  /// Also removes what killed runs left in the target's folder.
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

  /// Replaces bytes at an offset (in bytes from the start); they must lie inside what was written.
  /// \throws DatasetError if they cannot be written.
  void overwrite(std::uint64_t offset, std::string_view bytes);

  /// Writes all that is left and gives the file its name. To be called once, as the last call.
  /// \throws DatasetError if either fails; the target is then as it was.
  void close() { close_as(path_); }

  /// The same with another name in the target's folder; the target stays as it was.
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

#pragma once

/// \file
/// Files that appear whole or not at all.
///
/// The data is written to <name>.touchstone.partial-<process> beside the target, which takes the
/// target's name when it is complete; an older file stays as it is until then. A search for datasets
/// does not find such a name. The next run with the same target removes what a killed one left.
///
/// Devices and pipes, and all below /dev and /proc, are written to as they are; a symbolic link stays
/// one.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone::verify::io {

/// The place of a file of this name: behind symbolic links, also where nothing is yet.
[[nodiscard]] std::filesystem::path behind_links(std::filesystem::path path);

/// A file open for writing, buffered. Without close() nothing remains of it.
class OutputFile {
 public:
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
  void close() { close_as(""); }
  /// The same with an ending behind the name. A device has its name already.
  void close_as(const std::string& ending);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_device() const { return temporary_.empty(); }

 private:
  void open_temporary();
  void flush();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  /// Empty for a device, and for a file that has its name.
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
};

}  // namespace touchstone::verify::io

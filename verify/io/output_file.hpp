#pragma once

/// \file
/// Files that appear completely or not at all.
///
/// The data is written to <name>.touchstone.partial-<random> beside the target, which takes the
/// target's name when it is complete; an existing file is unchanged until then. A search for
/// datasets does not find such a name. A killed process leaves its file: on a common file system or
/// in a container nothing tells it from one that a living process writes.
///
/// Devices and pipes, and all files below /dev and /proc, are written to directly; a symbolic link
/// remains one.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "verify/io/descriptor.hpp"

namespace touchstone::verify::io {

/// The place at which a file of this name would be created: the target of symbolic links, also if
/// it does not exist yet.
[[nodiscard]] std::filesystem::path behind_links(std::filesystem::path path);

/// True if the name is that of a file that was being written: such a file is no input.
[[nodiscard]] bool is_partial(const std::filesystem::path& path);

/// A file open for writing, buffered. Without close() it is discarded.
class OutputFile {
 public:
  /// \throws DatasetError if no file can be made in the target's folder.
  explicit OutputFile(std::filesystem::path path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Removes the temporary file unless close() gave it the target's name.
  ~OutputFile();

  /// Appends bytes.
  /// \throws DatasetError if they cannot be written.
  void write(std::string_view bytes);

  /// Writes the bytes so far to the file, so that they are there if the process is killed.
  /// \throws DatasetError if they cannot be written.
  void flush();

  /// Replaces bytes at an offset (in bytes from the start); they must be within the written part.
  /// \throws DatasetError if they cannot be written.
  void overwrite(std::uint64_t offset, std::string_view bytes);

  /// Writes the rest and renames the file. Must be called once, as the last call.
  /// \throws DatasetError if either fails; the target is then unchanged.
  void close() { close_as(""); }
  /// The same with an ending behind the name; does not rename a device.
  void close_as(const std::string& ending);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_device() const { return temporary_.empty(); }

 private:
  void open_temporary();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  /// Empty for a device, and for a file that has its name.
  std::filesystem::path temporary_;
  Descriptor descriptor_;
  std::string buffer_;
};

}  // namespace touchstone::verify::io

#pragma once

/// \file
/// Sequential reading of files in bounded memory.
///
/// LineReader keeps no more of its file than one chunk and one line, and a line has an upper limit:
/// a file without line ends cannot fill the memory.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "verify/io/compressor.hpp"
#include "verify/io/descriptor.hpp"

namespace touchstone::verify::io {

/// A file open for reading.
class InputFile {
 public:
  /// \throws DatasetError if the file cannot be opened or is a folder.
  explicit InputFile(std::filesystem::path path);

  /// Reads at least one byte into the buffer, or none at the end of the file. Returns how many.
  /// \throws DatasetError if the system reports an error; the file is then treated as ended, so
  /// that a reader with keep_going cannot repeat the same error forever. Interrupted (terminal.hpp)
  /// if the user interrupts, also during a wait for input.
  [[nodiscard]] std::size_t read(std::span<char> buffer);

  /// Fills the buffer, or a part of it at the end of the file. Returns the number of bytes. Throws
  /// as read.
  [[nodiscard]] std::size_t read_all(std::span<char> buffer);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Size in bytes when the file was opened; 0 if it has none (a pipe).
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Bytes read so far as a fraction of the size, 0 to 1.
  [[nodiscard]] double progress() const;

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
  std::uint64_t size_ = 0;
  std::uint64_t consumed_ = 0;
  bool failed_ = false;
};

/// A line of a text file, without its line end (LF or CRLF).
struct Line {
  /// Refers to the reader's buffer: valid until the reader's next call.
  std::string_view text;
  /// Counted from 1.
  std::uint64_t number;
};

/// The lines of a text file, compressed if its name ends in ".zst" (compressor.hpp). Blank lines
/// (nothing, or spaces and tabs) at the end of the file are no lines; all others are. A byte order
/// mark of UTF-8 in front is passed over; one of UTF-16 is an error, and so are a CR that ends no
/// line or all and a line that is too long: after an error the file is treated as ended.
class LineReader {
 public:
  /// Maximum length of a line in bytes, without its line end.
  static constexpr std::size_t longest_line = std::size_t{1} << 20U;

  /// \throws DatasetError if the file cannot be opened.
  explicit LineReader(std::filesystem::path path);

  /// The next line; empty at the end.
  /// \throws DatasetError at an error, also of the system. Interrupted as InputFile::read.
  [[nodiscard]] std::optional<Line> next();

  /// True if next() has no more lines. Invalidates the text of the last line. Throws as next().
  [[nodiscard]] bool at_end();

  /// The bytes in front of next(): at least so many, or all that are left; none if at_end() has
  /// already looked for a line. Valid until the reader's next call. Throws as next().
  /// \pre bytes ≤ longest_line
  [[nodiscard]] std::string_view peek(std::size_t bytes);

  /// Skips bytes that peek() has returned; lines are not counted behind them.
  void skip(std::size_t bytes) { begin_ += bytes; }

  /// The number of bytes in front of what next() and peek() return.
  [[nodiscard]] std::uint64_t offset() const { return taken_ - (end_ - begin_); }

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  /// Fraction read so far, 0 to 1.
  [[nodiscard]] double progress() const { return file_.progress(); }

 private:
  void begin();
  std::optional<Line> read_line();
  Line take_line(std::size_t length, std::size_t terminator);
  void require_no_carriage_return(std::string_view text);
  [[noreturn]] void fail(const char* reason);
  bool fill();
  std::size_t read(std::span<char> space);
  std::size_t decompress(std::span<char> space);

  InputFile file_;
  std::optional<Decompressor> decompressor_;
  std::string compressed_;            ///< the last chunk read
  std::string_view compressed_left_;  ///< the unread part of it
  bool has_failed_ = false;           ///< the file is treated as ended
  bool has_begun_ = false;
  std::unique_ptr<char[]> buffer_;  // NOLINT(modernize-avoid-c-arrays): std::vector would fill it
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t taken_ = 0;  ///< bytes that were put into the buffer
  std::uint64_t line_number_ = 0;
  std::optional<Line> ahead_;
  std::uint64_t blank_lines_ahead_ = 0;
};

/// The text without the byte order mark of UTF-8 that it may begin with.
/// \throws DatasetError naming the file if it begins with the mark of UTF-16.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text,
                                                       const std::filesystem::path& path);

/// The bytes of a file. \throws DatasetError if it cannot be read or has more than `limit` bytes,
/// Interrupted as InputFile::read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, std::size_t limit);

/// The text without spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace touchstone::verify::io

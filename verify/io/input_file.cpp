#include "verify/io/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "verify/io/dataset_error.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::io {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 16U;
// A line that is just not too long, its CR, and room to read on.
constexpr std::size_t buffer_size = LineReader::longest_line + 1 + chunk;

constexpr const char* too_long = "line longer than 1 MiB";
constexpr const char* lone_carriage_return =
    "a carriage return within the line: lines end in LF or CR LF (from CR: tr '\\r' '\\n' <OLD "
    ">NEW)";

std::string last_system_error() { return std::generic_category().message(errno); }

}  // namespace

InputFile::InputFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_.get() < 0 || ::fstat(descriptor_.get(), &status) != 0) {
    throw DatasetError(path_, {}, "cannot open: " + last_system_error());
  }
  if (S_ISDIR(status.st_mode)) throw DatasetError(path_, {}, "is a folder");
  size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
}

std::size_t InputFile::read(std::span<char> buffer) {
  if (failed_) return 0;
  for (;;) {
    wait_for_input(descriptor_.get());
    const ssize_t count = ::read(descriptor_.get(), buffer.data(), buffer.size());
    if (count >= 0) {
      consumed_ += static_cast<std::uint64_t>(count);
      return static_cast<std::size_t>(count);
    }
    if (errno == EINTR) continue;
    failed_ = true;
    throw DatasetError(path_, {}, "cannot read: " + last_system_error());
  }
}

std::size_t InputFile::read_all(std::span<char> buffer) {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const std::size_t count = read(buffer.subspan(done));
    if (count == 0) break;
    done += count;
  }
  return done;
}

double InputFile::progress() const {
  if (size_ == 0) return 0.0;
  return std::min(1.0, static_cast<double>(consumed_) / static_cast<double>(size_));
}

LineReader::LineReader(std::filesystem::path path)
    : file_(std::move(path)),
      // NOLINTNEXTLINE(modernize-avoid-c-arrays): std::vector would fill it
      buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {
  if (this->path().extension() == ".zst") decompressor_.emplace();
}

bool LineReader::at_end() {
  if (ahead_) return false;
  ahead_ = read_line();
  while (ahead_ && trimmed(ahead_->text).empty()) {
    ++blank_lines_ahead_;
    ahead_ = read_line();
  }
  return !ahead_;
}

std::optional<Line> LineReader::next() {
  if (at_end()) return std::nullopt;
  if (blank_lines_ahead_ > 0) {
    return Line{.text = {}, .number = ahead_->number - blank_lines_ahead_--};
  }
  return std::exchange(ahead_, std::nullopt);
}

std::string_view LineReader::peek(std::size_t bytes) {
  if (ahead_) return {};
  begin();
  while (end_ - begin_ < bytes && fill()) {
  }
  return {buffer_.get() + begin_, end_ - begin_};
}

void LineReader::begin() {
  if (std::exchange(has_begun_, true)) return;
  static constexpr std::size_t longest_mark = 3;
  while (end_ < longest_mark && fill()) {
  }
  has_failed_ = true;  // after an exception
  const std::string_view text(buffer_.get(), std::exchange(end_, 0));
  begin_ = text.size() - without_byte_order_mark(text, path()).size();
  end_ = text.size();
  has_failed_ = false;
}

std::optional<Line> LineReader::read_line() {
  begin();
  std::size_t searched = 0;
  for (;;) {
    const char* const from = buffer_.get() + begin_;
    const std::size_t available = end_ - begin_;
    const void* const newline = std::memchr(from + searched, '\n', available - searched);
    if (newline != nullptr) {
      return take_line(static_cast<std::size_t>(static_cast<const char*>(newline) - from), 1);
    }
    searched = available;
    if (available > longest_line + 1) {
      require_no_carriage_return({from, available - 1});  // The last one may belong to an LF.
      fail(too_long);
    }
    if (fill()) continue;
    if (available == 0) return std::nullopt;
    return take_line(available, 0);
  }
}

Line LineReader::take_line(std::size_t length, std::size_t terminator) {
  std::string_view text(buffer_.get() + begin_, length);
  begin_ += length + terminator;
  if (text.ends_with('\r')) text.remove_suffix(1);
  require_no_carriage_return(text);
  if (text.size() > longest_line) fail(too_long);
  return {.text = text, .number = ++line_number_};
}

void LineReader::require_no_carriage_return(std::string_view text) {
  if (text.find('\r') != std::string_view::npos) fail(lone_carriage_return);
}

/// Ends the file at the line behind the last one.
void LineReader::fail(const char* reason) {
  has_failed_ = true;
  begin_ = end_;
  throw DatasetError(path(), {.line = line_number_ + 1}, reason);
}

/// Moves the unread bytes to the front and reads a chunk after them; false at the end of the file.
bool LineReader::fill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t space = std::min(chunk, buffer_size - end_);
  const std::size_t count = read({buffer_.get() + end_, space});
  end_ += count;
  taken_ += count;
  return count > 0;
}

/// At least one byte, or none at the end.
std::size_t LineReader::read(std::span<char> space) {
  if (has_failed_) return 0;
  if (!decompressor_) return file_.read(space);
  for (;;) {
    if (compressed_left_.empty()) {
      compressed_.resize(chunk);
      compressed_.resize(file_.read(compressed_));
      compressed_left_ = compressed_;
    }
    const bool is_at_end = compressed_left_.empty();
    if (is_at_end && decompressor_->is_complete()) return 0;
    const std::size_t count = decompress(space);
    if (count > 0) return count;
    if (!is_at_end) continue;
    has_failed_ = true;
    throw DatasetError(path(), {}, "its compressed stream is cut");
  }
}

std::size_t LineReader::decompress(std::span<char> space) {
  try {
    return decompressor_->decompress(compressed_left_, space);
  } catch (const std::runtime_error& error) {
    has_failed_ = true;
    throw DatasetError(path(), {}, error.what());
  }
}

std::string_view without_byte_order_mark(std::string_view text, const std::filesystem::path& path) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw DatasetError(path, {.line = 1}, "UTF-16 text; UTF-8 is read: iconv -f UTF-16 -t UTF-8");
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  InputFile file(path);
  std::string bytes;
  for (std::size_t count = 1; count > 0;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + chunk);
    count = file.read({bytes.data() + before, chunk});
    bytes.resize(before + count);
    if (bytes.size() > limit) {
      throw DatasetError(path, {}, "has more than " + std::to_string(limit) + " bytes");
    }
  }
  return bytes;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace touchstone::verify::io

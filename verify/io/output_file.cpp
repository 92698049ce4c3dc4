#include "verify/io/output_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "verify/data/dataset_error.hpp"

namespace touchstone::verify::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 16U;
constexpr std::string_view temporary_extension = ".touchstone.partial-";

/// A temporary name beside the target.
fs::path temporary_name(const fs::path& target, unsigned attempt) {
  static constexpr std::size_t longest = 255;
  const std::string ending =
      std::string(temporary_extension) + std::to_string(::getpid()) + "-" + std::to_string(attempt);
  const std::string name = target.filename().string();
  // Some file systems refuse half a character of UTF-8.
  return target.parent_path() /
         (std::string(data::beginning(name, longest - ending.size())) + ending);
}

/// True if it has the form of the temporary names.
bool is_temporary_name(std::string_view name) {
  const std::size_t at = name.rfind(temporary_extension);
  if (at == std::string_view::npos) return false;
  const std::string_view numbers = name.substr(at + temporary_extension.size());
  const std::size_t dash = numbers.find('-');
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && is_number(numbers.substr(0, dash)) &&
         is_number(numbers.substr(dash + 1));
}

/// True if the open file is a regular one, and still the one of that name.
bool has_name(int descriptor, const fs::path& path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         S_ISREG(named.st_mode) && opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Removes a temporary file unless somebody holds its lock, or the file system has no locks.
void remove_if_abandoned(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool is_abandoned = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  if (is_abandoned && has_name(descriptor, path)) ::unlink(path.c_str());
  ::close(descriptor);
}

void remove_abandoned_files(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (is_temporary_name(entry->path().filename().string())) remove_if_abandoned(entry->path());
  }
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  remove_abandoned_files(path_.parent_path());
  // The temporary name would hide until close() that the target's is too long.
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0 && errno == ENAMETOOLONG) fail();
  for (unsigned attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = temporary_name(path_, attempt);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail();
    if (descriptor_ >= 0 && !lock()) ::close(std::exchange(descriptor_, -1));
  }
  buffer_.reserve(buffer_size);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > buffer_size) flush();
  buffer_ += bytes;
}

void OutputFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

/// Takes the lock; false if another process has found the file abandoned, and removes it.
bool OutputFile::lock() const {
  // On file systems without locks no temporary file is removed.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  struct stat status {};
  const bool is_unlinked = ::fstat(descriptor_, &status) == 0 && status.st_nlink == 0;
  return !is_unlinked || has_name(descriptor_, temporary_);
}

void OutputFile::close_as(const std::filesystem::path& path) {
  flush();
  // The lock is held through a second descriptor until the file has its name.
  const int lock = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
  if (lock < 0) fail();
  // Some file systems report a full disk or quota only here.
  const bool is_closed = ::close(std::exchange(descriptor_, lock)) == 0;
  if (!is_closed || ::rename(temporary_.c_str(), path.c_str()) != 0) fail();
  temporary_.clear();
  ::close(std::exchange(descriptor_, -1));
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::fail() const {
  throw data::DatasetError(path_, {}, "cannot write: " + std::generic_category().message(errno));
}

}  // namespace touchstone::verify::io

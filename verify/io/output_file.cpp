#include "verify/io/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <iterator>
#include <random>
#include <system_error>
#include <utility>

#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t output_buffer_size = std::size_t{1} << 16U;
/// The maximum number of consecutive symbolic links, as in the system; more are treated as a cycle.
constexpr int most_links = 40;

/// True if the system uses the name for an open descriptor.
bool is_below_system_folder(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const auto first = std::next(absolute.begin());
  return first != absolute.end() && (*first == "dev" || *first == "proc");
}

/// True unless it is a regular file or does not exist.
bool is_special(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return (status.type() != fs::file_type::regular && status.type() != fs::file_type::not_found) ||
         is_below_system_folder(path);
}

/// A name that nobody else takes, on any machine: 64 random bits in hexadecimal digits.
std::string unused_name() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

fs::path behind_links(fs::path path) {
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical;
}

constexpr const char* partial_mark = ".touchstone.partial-";

bool is_partial(const fs::path& path) {
  return path.filename().string().find(partial_mark) != std::string::npos;
}

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  if (is_special(path_)) {
    // Never truncates: standard output may be a file that others have written to.
    descriptor_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_APPEND | O_NOCTTY | O_CLOEXEC));
  } else {
    open_temporary();
  }
  if (descriptor_.get() < 0) fail();
  buffer_.reserve(output_buffer_size);
}

void OutputFile::open_temporary() {
  path_ = behind_links(path_);
  temporary_ = path_.string() + partial_mark + unused_name();
  descriptor_ =
      Descriptor(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (descriptor_.get() < 0) temporary_.clear();
}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > output_buffer_size) flush();
  buffer_ += bytes;
}

void OutputFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(descriptor_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void OutputFile::close_as(const std::string& ending) {
  flush();
  // Some file systems report a full disk or quota only here.
  if (descriptor_.close() != 0) fail();
  if (is_device()) return;
  if (::rename(temporary_.c_str(), (path_.string() + ending).c_str()) != 0) fail();
  temporary_.clear();
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_.get(), rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail();
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::fail() const {
  throw DatasetError(path_, {}, "cannot write: " + std::generic_category().message(errno));
}

}  // namespace touchstone::verify::io

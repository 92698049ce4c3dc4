#include "verify/cli/files.hpp"

#include <cerrno>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "verify/cli/options.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

/// More symbolic links than this in a row are a ring, as they are for the system.
constexpr int most_links = 40;

/// Where a file of this name would come to be: behind symbolic links, also to what is not there yet.
fs::path behind_links(fs::path path) {
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? path : canonical;
}

/// \throws std::runtime_error with the reason that the system has given.
[[noreturn]] void fail(const std::string& name, const std::string& what, int reason) {
  throw std::runtime_error(name + ": " + what + ": " + std::generic_category().message(reason));
}

/// Is it a name that the system gives to what is open already?
bool is_below_system_folder(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const auto first = std::next(absolute.begin());
  return first != absolute.end() && (*first == "dev" || *first == "proc");
}

/// Is it anything but a file, or nothing yet? \throws std::runtime_error if the system does not say.
bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::status_known(status)) fail(path.string(), "cannot be written", error.value());
  return (fs::exists(status) && !fs::is_regular_file(status)) || is_below_system_folder(path);
}

bool is_standard_output(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute == "/dev/stdout" || absolute == "/dev/fd/1" || absolute == "/proc/self/fd/1";
}

}  // namespace

// ---- The record ---------------------------------------------------------------------------------

void Files::add_input(const fs::path& file) {
  std::error_code error;
  // A pipe or terminal may be both ends of something.
  const bool is_other = fs::is_other(fs::status(file, error));
  if (file.empty() || is_other) return;
  const fs::path place = behind_links(file);
  if (outputs_.contains(place)) {
    throw std::runtime_error(file.string() + ": named for input and output");
  }
  inputs_.emplace(place, file);
}

void Files::add_inputs(std::span<const fs::path> files) {
  for (const fs::path& file : files) add_input(file);
}

void Files::add_dataset(const fs::path& file) {
  add_inputs(data::find_ground_truth_files(file));
  add_input(file);
}

void Files::add_output(const fs::path& file) {
  const fs::path place = behind_links(file);
  if (const auto input = inputs_.find(place); input != inputs_.end()) {
    throw std::runtime_error(input->second.string() + ": named for input and output");
  }
  if (!outputs_.insert(place).second) {
    throw std::runtime_error(file.string() + ": named for two outputs");
  }
  writes_standard_output_ = writes_standard_output_ || is_standard_output(file);
}

std::FILE* Files::summary_stream() const { return writes_standard_output_ ? stderr : stdout; }

// ---- An output ----------------------------------------------------------------------------------

Output::Output(Files& files, const std::string& name)
    : files_(files), name_(name == "-" ? "/dev/stdout" : name) {
  if (name_.empty()) return;
  files.add_output(name_);
  if (is_device(name_)) {
    // Never truncates: standard output may be a file that others have written to.
    const int descriptor = io::open_for_appending(name_);
    if (descriptor >= 0) device_.reset(::fdopen(descriptor, "a"));
    if (!device_) fail(name_, "cannot be opened for writing", errno);
  } else {
    file_ = std::make_unique<io::OutputFile>(behind_links(name_));
  }
}

template <class Action>
void Output::attempt(const Action& action) {
  if (name_.empty() || failed_) return;
  try {
    action();
  } catch (const std::exception& error) {
    report_error(error.what());
    failed_ = true;
    files_.note_failure();
  }
}

void Output::write(std::string_view text) {
  attempt([&] {
    if (file_) {
      file_->write(text);
    } else if (std::fwrite(text.data(), 1, text.size(), device_.get()) != text.size()) {
      fail(name_, "cannot be written", errno);
    }
  });
}

void Output::close_incomplete() {
  static constexpr const char* ending = ".incomplete";
  close_as(ending);
  if (file_ && !failed_) {
    report_warning(file_->path().string() + ending + ": not complete; " + name_ + " is as it was");
  }
}

void Output::close_as(const std::string& ending) {
  attempt([&] {
    if (file_) {
      file_->close_as(file_->path().string() + ending);
    } else if (device_ && std::fclose(device_.release()) != 0) {
      fail(name_, "cannot be written", errno);
    }
  });
}

}  // namespace touchstone::verify::cli

#include "verify/cli/files.hpp"

#include <exception>
#include <stdexcept>
#include <system_error>

#include "verify/cli/options.hpp"
#include "verify/data/ground_truth_files.hpp"

namespace touchstone::verify::cli {
namespace {

namespace fs = std::filesystem;

bool is_standard_output(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute == "/dev/stdout" || absolute == "/dev/fd/1" || absolute == "/proc/self/fd/1";
}

}  // namespace

// ---- The record ---------------------------------------------------------------------------------

void Files::add_input(const fs::path& file) {
  std::error_code error;
  // A pipe or terminal may be both an input and an output.
  const bool is_other = fs::is_other(fs::status(file, error));
  if (file.empty() || is_other) return;
  const fs::path place = io::behind_links(file);
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
  const fs::path place = io::behind_links(file);
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

Output::Output(Files& files, const std::string& name, std::string_view header)
    : files_(files), name_(name == "-" ? "/dev/stdout" : name) {
  if (name_.empty()) return;
  files.add_output(name_);
  file_.emplace(name_);
  if (name_.ends_with(".zst")) compressor_.emplace();
  write(header);
}

template <class Action>
void Output::attempt(const Action& action) {
  if (!file_ || failed_) return;
  try {
    action();
  } catch (const std::exception& error) {
    report_error(error.what());
    failed_ = true;
    files_.note_failure();
  }
}

void Output::put(std::string_view text, bool is_last) {
  std::string compressed;
  if (compressor_) {
    compressed = compressor_->compress(text);
    if (is_last) compressed += compressor_->finish();
    text = compressed;
  }
  file_->write(text);
  bytes_ += text.size();
}

void Output::write(std::string_view text) {
  attempt([&] { put(text, false); });
}

void Output::write_through(std::string_view text) {
  attempt([&] {
    file_->write(text);
    file_->flush();
  });
}

void Output::close() {
  attempt([&] {
    put({}, true);
    file_->close();
  });
}

void Output::complete_with(const std::function<std::string()>& make) {
  attempt([&] {
    try {
      put(make(), true);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error(name_ + ": not enough memory for all that it would hold");
    }
    file_->close();
  });
}

void Output::close_incomplete() {
  attempt([&] {
    static constexpr const char* ending = ".incomplete";
    const bool is_named = !file_->is_device();
    put({}, true);
    file_->close_as(ending);
    if (!is_named) return;
    report_warning(file_->path().string() + ending + ": not complete; " + name_ + " is as it was");
  });
}

}  // namespace touchstone::verify::cli

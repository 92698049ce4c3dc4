#include "verify/cli/options.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>

#include "verify/data/separation_file.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/judge/separation_inference.hpp"

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

/// Is it a name that the system gives to what is open already?
bool is_below_system_folder(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const auto first = std::next(absolute.begin());
  return first != absolute.end() && (*first == "dev" || *first == "proc");
}

bool is_device(const fs::path& path) {
  const fs::file_status status = fs::status(path);
  return (fs::exists(status) && !fs::is_regular_file(status)) || is_below_system_folder(path);
}

}  // namespace

CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest) {
  const auto check = [least, greatest](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stopped == end && value >= least && value <= greatest) return {};
    return fmt::format("{} is no whole number from {} to {}", text, least, greatest);
  };
  return {check, ""};
}

CLI::Validator real_number(double least, double greatest) {
  const auto check = [least, greatest](const std::string& text) -> std::string {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stopped == end && value >= least && value <= greatest) return {};
    return fmt::format("{} is no number from {} to {}", text, least, greatest);
  };
  return {check, ""};
}

CLI::Validator distance_number() {
  const auto check = [](const std::string& text) -> std::string {
    if (data::distance_from_text(text)) return {};
    return fmt::format("{} is no finite number from 0 on", text);
  };
  return {check, ""};
}

Separation SeparationArguments::given() const {
  return {.distance = distance.value_or(0.0), .norm = norm.value_or(Norm::linf)};
}

Separation SeparationArguments::settle(const Separation& recorded) const {
  if (is_contact(recorded)) return given();
  const Separation asked{.distance = distance.value_or(recorded.distance),
                         .norm = norm.value_or(recorded.norm)};
  if (judge::same_separation(asked, recorded)) return asked;
  throw std::invalid_argument(
      fmt::format("asked for a minimum separation of {}, but its separation.json says {}",
                  judge::to_text(asked), judge::to_text(recorded)));
}

CLI::Option* add_distance_option(CLI::App& command, std::optional<double>& distance,
                                 const std::string& description) {
  // Read by strtod: CLI11 would round twice.
  return command
      .add_option_function<std::string>(
          "--min-separation",
          [&distance](const std::string& text) { distance = data::distance_from_text(text); },
          description)
      ->type_name("D")
      ->check(distance_number());
}

void add_separation_options(CLI::App& command, SeparationArguments& arguments) {
  add_distance_option(command, arguments.distance,
                      "Contact: distance ≤ D, decimal or 0x1p-10 (default: 0 or separation.json)");
  command
      .add_option_function<std::string>(
          "--norm",
          [&arguments](const std::string& text) { arguments.norm = norm_from_string(text); },
          "Norm of the distance: linf (greatest component, the default) or l2")
      ->type_name("NORM")
      ->check(CLI::IsMember({"linf", "l2"}).description(""));
}

void add_json_option(CLI::App& command, std::string& file) {
  command.add_option("--json", file, "Write the result as JSON")->type_name("FILE");
}

void add_kind_option(CLI::App& command, std::string& kind, const std::string& description) {
  command.add_option("--kind", kind, description)
      ->type_name("KIND")
      ->check(CLI::IsMember({"vertex-face", "edge-edge"}).description(""));
}

void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& description) {
  command.add_option("--seed", seed, description)
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(0, UINT64_MAX));
}

void report_error(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: error: {}\n", io::printable(message)));
}

void report_warning(std::string_view message) {
  io::print(stderr, fmt::format("touchstone: warning: {}\n", io::printable(message)));
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string command;
  for (std::string word; std::getline(file, word, '\0');) {
    command += command.empty() ? "touchstone" : " " + io::shell_word(word);
  }
  return command;
}

OptionalOutput::OptionalOutput(const std::string& name) : name_(name) {
  if (name.empty()) return;
  if (is_device(name)) {
    // Never truncates: standard output may be a file that others have written to.
    const int descriptor = io::open_for_appending(name);
    if (descriptor >= 0) device_.reset(::fdopen(descriptor, "a"));
    if (!device_) throw failure("cannot be opened for writing");
  } else {
    file_ = std::make_unique<io::OutputFile>(behind_links(name));
  }
}

bool OptionalOutput::is(const fs::path& path) const {
  return !name_.empty() && !path.empty() && behind_links(name_) == behind_links(path);
}

bool OptionalOutput::is_standard_output() const {
  const fs::path path = name_.empty() ? fs::path() : fs::absolute(name_).lexically_normal();
  return path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

void OptionalOutput::write(std::string_view text) {
  if (file_) {
    file_->write(text);
  } else if (std::fwrite(text.data(), 1, text.size(), device_.get()) != text.size()) {
    throw failure("cannot be written");
  }
}

void OptionalOutput::close() {
  if (file_) {
    file_->close();
  } else if (device_ && std::fclose(device_.release()) != 0) {
    throw failure("cannot be written");
  }
}

std::runtime_error OptionalOutput::failure(const std::string& what) const {
  return std::runtime_error(name_ + ": " + what + ": " + std::generic_category().message(errno));
}

void ReportedOutput::write(std::string_view text) {
  if (!output_ || failed_) return;
  try {
    output_.write(text);
  } catch (const std::exception& error) {
    report_error(error.what());
    failed_ = true;
  }
}

void ReportedOutput::close() {
  if (!output_ || failed_) return;
  try {
    output_.close();
  } catch (const std::exception& error) {
    report_error(error.what());
    failed_ = true;
  }
}

}  // namespace touchstone::verify::cli

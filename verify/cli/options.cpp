#include "verify/cli/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <system_error>

namespace touchstone::verify::cli {

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

void report_error(std::string_view message) {
  fmt::print(stderr, "touchstone: error: {}\n", message);
}

void report_warning(std::string_view message) {
  fmt::print(stderr, "touchstone: warning: {}\n", message);
}

OptionalOutput::OptionalOutput(const std::string& name) : name_(name) {
  if (name.empty()) return;
  const std::filesystem::file_status status = std::filesystem::status(name);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    device_.open(name, std::ios::binary);
    if (!device_) throw std::runtime_error(name + ": cannot be opened for writing");
  } else {
    file_ = std::make_unique<OutputFile>(name);
  }
}

bool OptionalOutput::is(const std::filesystem::path& path) const {
  std::error_code error;
  const auto canonical = [&](const std::filesystem::path& p) {
    return std::filesystem::weakly_canonical(p, error);
  };
  return !name_.empty() && canonical(name_) == canonical(path) && !error;
}

void OptionalOutput::write(std::string_view text) {
  if (file_) {
    file_->write(text);
  } else {
    device_ << text;
  }
}

void OptionalOutput::close() {
  if (file_) {
    file_->close();
  } else if (device_.is_open()) {
    device_.close();
    if (!device_) throw std::runtime_error(name_ + ": cannot be written");
  }
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

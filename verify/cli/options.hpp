#pragma once

/// \file
/// Pieces of the command line that several subcommands share.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "verify/dataset/output_file.hpp"

namespace touchstone::verify::cli {

/// The default seed of everything that is generated.
inline constexpr std::uint64_t default_seed = 2021;

/// Accepts whole numbers from `least` to `greatest` (CLI11 alone lets "-1" wrap around).
[[nodiscard]] CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest);

/// Accepts finite numbers from `least` to `greatest`.
[[nodiscard]] CLI::Validator real_number(double least, double greatest);

/// Prints "touchstone: error: …" on standard error.
void report_error(std::string_view message);

/// Prints "touchstone: warning: …" on standard error.
void report_warning(std::string_view message);

/// A file to write to if the user named one. It is opened before the work begins, so that a bad name
/// costs nothing, and takes its name when it is complete, so that nothing older is lost before.
/// Devices and pipes, and all below /dev and /proc, are written to as they are; a symbolic link stays
/// one.
class OptionalOutput {
 public:
  /// No file if the name is empty. \throws DatasetError or std::runtime_error if none can be made.
  explicit OptionalOutput(const std::string& name);

  [[nodiscard]] explicit operator bool() const { return !name_.empty(); }

  /// Is it this process's standard output, by a name of the system's for it?
  [[nodiscard]] bool is_standard_output() const;

  /// Is it the file at `path`, by whatever name?
  [[nodiscard]] bool is(const std::filesystem::path& path) const;

  /// \pre a file was named. \throws as the constructor does.
  void write(std::string_view text);

  /// Completes the file, if there is one. \throws as the constructor does.
  void close();

 private:
  std::string name_;
  std::unique_ptr<OutputFile> file_;
  std::ofstream device_;
};

/// An output whose failure is reported, once, and costs nothing else: the work goes on without it.
class ReportedOutput {
 public:
  /// \throws as OptionalOutput does: before the work begins, a failure ends the run.
  explicit ReportedOutput(const std::string& name) : output_(name) {}

  /// Was a file named?
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }
  [[nodiscard]] bool is(const std::filesystem::path& path) const { return output_.is(path); }
  [[nodiscard]] bool is_standard_output() const { return output_.is_standard_output(); }
  [[nodiscard]] bool failed() const { return failed_; }

  /// Does nothing if no file was named or a step has failed.
  void write(std::string_view text);
  void close();

 private:
  OptionalOutput output_;
  bool failed_ = false;
};

}  // namespace touchstone::verify::cli

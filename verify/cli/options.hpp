#pragma once

/// \file
/// Pieces of the command line that several subcommands share.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "exact/query.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::cli {

/// The default seed of everything that is generated.
inline constexpr std::uint64_t default_seed = 2021;

/// Accepts whole numbers from `least` to `greatest` (CLI11 alone lets "-1" wrap around).
[[nodiscard]] CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest);

/// Accepts finite numbers from `least` to `greatest`.
[[nodiscard]] CLI::Validator real_number(double least, double greatest);

/// Accepts finite numbers from 0 on as strtod takes them, hexadecimal ones too, that do not become 0.
[[nodiscard]] CLI::Validator distance_number();

/// The separation that the user asked for.
struct SeparationArguments {
  std::optional<double> distance;
  std::optional<Norm> norm;

  /// The separation asked for on the command line; contact itself if nothing is said.
  [[nodiscard]] Separation given() const;

  /// The separation to ask for of queries whose recorded answers are about `recorded`: that one if
  /// nothing is said. Answers about contact contradict nothing.
  /// \throws std::invalid_argument naming both if what is said contradicts what is recorded.
  [[nodiscard]] Separation settle(const Separation& recorded) const;
};

/// Adds --min-separation; the double must live until the command line is parsed.
CLI::Option* add_distance_option(CLI::App& command, std::optional<double>& distance,
                                 const std::string& description);

/// Adds --min-separation and --norm; the arguments must live until the command line is parsed.
void add_separation_options(CLI::App& command, SeparationArguments& arguments);

/// Adds --json FILE. The text must live until the command line is parsed, as all arguments below.
void add_json_option(CLI::App& command, std::string& file);

/// Adds --kind, which limits a command to queries of one kind, or says the kind of all.
void add_kind_option(CLI::App& command, std::string& kind, const std::string& description);

/// Adds --seed.
void add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& description);

/// Prints "touchstone: error: …" on standard error, printable (printable.hpp).
void report_error(std::string_view message);

/// Prints "touchstone: warning: …" on standard error, printable.
void report_warning(std::string_view message);

/// The command line of this process, as one types it, the program's name without a path.
[[nodiscard]] std::string command_line();

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
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// With the reason that the system has given. \pre errno is set
  [[nodiscard]] std::runtime_error failure(const std::string& what) const;

  std::string name_;
  std::unique_ptr<io::OutputFile> file_;
  std::unique_ptr<std::FILE, CloseFile> device_;
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

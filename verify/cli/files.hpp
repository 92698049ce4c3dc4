#pragma once

/// \file
/// The files of a command: each is read or written, and written as one output only.
///
/// An output takes the place of the file of its name. So the record of a run knows every output from
/// the moment it is opened, and every input before it is read, those found in folders too: a file in
/// two roles is an error before anything is lost.

#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "verify/io/output_file.hpp"

namespace touchstone::verify::cli {

/// The record of a run.
class Files {
 public:
  /// Enters a file that is read; an empty name is no file.
  /// \throws std::runtime_error if it is an output.
  void add_input(const std::filesystem::path& file);
  void add_inputs(std::span<const std::filesystem::path> files);

  /// Enters a dataset, and the files beside it with its labels, times of impact and separation.
  /// \throws std::runtime_error as add_input.
  void add_dataset(const std::filesystem::path& file);

  /// Enters a file that is written. \throws std::runtime_error if it is an input or another output.
  void add_output(const std::filesystem::path& file);

  /// Where a run prints its summary: on standard error if standard output is an output's.
  [[nodiscard]] std::FILE* summary_stream() const;

  /// Could an output not be written?
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  void note_failure() { has_failed_ = true; }

 private:
  /// By their places behind all symbolic links, with the names that the user knows.
  std::map<std::filesystem::path, std::filesystem::path> inputs_;
  std::set<std::filesystem::path> outputs_;
  bool writes_standard_output_ = false;
  bool has_failed_ = false;
};

/// A file to write to if the user named one; "-" is standard output. It is opened before the work
/// begins, so that a bad name costs nothing, and takes its name when it is complete, so that nothing
/// older is lost before (io::OutputFile).
///
/// A failure to write is reported, once, and the work goes on without the file.
class Output {
 public:
  /// \param files its record, which must live as long as it
  /// \throws std::runtime_error as Files::add_output, or if the file cannot be made.
  Output(Files& files, const std::string& name);

  /// Was a file named?
  [[nodiscard]] explicit operator bool() const { return !name_.empty(); }
  [[nodiscard]] bool failed() const { return failed_; }

  /// Does nothing if no file was named or it has failed.
  void write(std::string_view text);
  /// Completes the file.
  void close();
  /// The same for what is not all that it should be: the file gets the ending ".incomplete", one of the name
  /// that the user gave stays as it was, and a warning says so.
  void close_incomplete();

 private:
  template <class Action>
  void attempt(const Action& action);

  Files& files_;
  std::string name_;
  std::optional<io::OutputFile> file_;
  bool failed_ = false;
};

}  // namespace touchstone::verify::cli

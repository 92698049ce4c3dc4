#pragma once

/// \file
/// The files of a command: each is either an input or one output.
///
/// An output replaces the file of its name. Therefore the record of a run knows every output when
/// it is opened, and every input before it is read, including those found in folders: a file in two
/// roles is an error before any data is lost.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "verify/io/compressor.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::cli {

/// The record of a run.
class Files {
 public:
  /// Adds an input file; an empty name means none.
  /// \throws std::runtime_error if it is an output.
  void add_input(const std::filesystem::path& file);
  void add_inputs(std::span<const std::filesystem::path> files);

  /// Adds a dataset, and its companion files with labels, times of impact and separation.
  /// \throws std::runtime_error as add_input.
  void add_dataset(const std::filesystem::path& file);

  /// Adds an output file. \throws std::runtime_error if it is an input or another output.
  void add_output(const std::filesystem::path& file);

  /// The stream of a run's summary: standard error if standard output is an output file.
  [[nodiscard]] std::FILE* summary_stream() const;

  /// True if an output could not be written.
  [[nodiscard]] bool has_failed() const { return has_failed_; }
  void note_failure() { has_failed_ = true; }

 private:
  /// The files by their resolved paths, with the names from the command line.
  std::map<std::filesystem::path, std::filesystem::path> inputs_;
  std::set<std::filesystem::path> outputs_;
  bool writes_standard_output_ = false;
  bool has_failed_ = false;
};

/// An optional output file; "-" is standard output. It is opened before the work begins, so that a
/// bad name is reported early, and is renamed when it is complete, so that an existing file is kept
/// until then. Devices and pipes, and all files below /dev and /proc, are written to directly; a
/// symbolic link remains one. It is compressed if its name ends in ".zst".
///
/// A failure to write is reported once, and the work continues without the file.
class Output {
 public:
  /// \param files its record, which must live as long as it
  /// \param header the first line
  /// \throws std::runtime_error as Files::add_output, or if the file cannot be created.
  Output(Files& files, const std::string& name, std::string_view header = {});

  /// True if a file was named.
  [[nodiscard]] explicit operator bool() const { return !name_.empty(); }
  [[nodiscard]] bool failed() const { return failed_; }
  /// Bytes of the file so far.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Does nothing if no file was named or it has failed.
  void write(std::string_view text);
  /// Writes a part that is complete by itself, which stays in the incomplete file
  /// (verify/io/output_file.hpp) if this process is killed.
  void write_through(std::string_view text);
  /// Completes the file.
  void close();
  /// Writes the text, and completes the file.
  void complete(std::string_view text) {
    write(text);
    close();
  }
  /// The same with the text that a function makes, which may take more memory than there is; its
  /// failure is reported like one to write.
  void complete_with(const std::function<std::string()>& make);
  /// Leaves the file of that name as it was; text that is written later is lost.
  void discard() {
    file_.reset();
    bytes_ = 0;
  }
  /// Closes an incomplete file: it gets the ending ".incomplete", an existing file of the given
  /// name stays as it was, and a warning says so.
  void close_incomplete();

 private:
  template <class Action>
  void attempt(const Action& action);
  /// Writes the text, and what the compressor has kept if it is the last one.
  void put(std::string_view text, bool is_last);

  Files& files_;
  std::string name_;
  std::optional<io::OutputFile> file_;
  std::optional<io::Compressor> compressor_;
  std::uint64_t bytes_ = 0;
  bool failed_ = false;
};

}  // namespace touchstone::verify::cli

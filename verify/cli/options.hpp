#pragma once

/// \file
/// Pieces of the command line that several subcommands share.

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "exact/query.hpp"

namespace touchstone::verify::cli {

/// The default seed of everything that is generated.
inline constexpr unsigned default_seed = 2021;

/// An output file that is opened before the work begins, so that a bad name costs nothing.
class OptionalOutput {
 public:
  /// No file if the name is empty. \throws std::runtime_error if it cannot be opened for writing.
  explicit OptionalOutput(const std::string& name);

  [[nodiscard]] explicit operator bool() const { return !name_.empty(); }
  [[nodiscard]] std::ostream& stream() { return file_; }

  /// Completes the file. \throws std::runtime_error if not all of it could be written.
  void close();

 private:
  std::string name_;
  std::ofstream file_;
};

}  // namespace touchstone::verify::cli

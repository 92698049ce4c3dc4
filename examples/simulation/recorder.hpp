#pragma once

/// \file
/// Queries in files, with the oracle's truth: as CSV with a label in each row, the format of
/// the 2021 benchmark, or as a NumPy array with the labels in a separate file.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "touchstone/query.hpp"

namespace touchstone::simulation {

struct RecorderOptions {
  std::filesystem::path folder;
  std::string name;  ///< of the files: FOLDER/vertex-face/NAME.csv or .npy, and edge-edge likewise
  bool as_npy = false;  ///< an eighth of the size
};

class Recorder {
 public:
  /// \throws verify::io::DatasetError if no file can be created there.
  explicit Recorder(RecorderOptions options);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  Recorder(Recorder&&) = delete;
  Recorder& operator=(Recorder&&) = delete;

  void add(Kind kind, const Query& query);

  /// Writes the rest, and renames the files. \throws verify::io::DatasetError if it cannot be
  /// written.
  void close();

  [[nodiscard]] std::uint64_t queries(Kind kind) const;
  [[nodiscard]] std::uint64_t collisions(Kind kind) const;

 private:
  class File;

  RecorderOptions options_;
  std::array<std::unique_ptr<File>, 2> files_;
};

}  // namespace touchstone::simulation

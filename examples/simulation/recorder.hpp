#pragma once

/// \file
/// Queries in files, with the oracle's truth: NumPy arrays with the labels in a separate file, a
/// format of the public data [wang2021].

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "touchstone/query.hpp"
#include "verify/data/npy.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::simulation {

class Recorder {
 public:
  /// Makes FOLDER/vertex-face/NAME.npy and FOLDER/edge-edge/NAME.npy.
  /// \throws verify::io::DatasetError if no file can be created there.
  Recorder(const std::filesystem::path& folder, const std::string& name);

  void add(ContactKind kind, const Query& query);

  /// Gives the files their names. \throws verify::io::DatasetError if they cannot be written.
  void close();

  [[nodiscard]] std::uint64_t queries(ContactKind kind) const { return file(kind).queries; }
  [[nodiscard]] std::uint64_t collisions(ContactKind kind) const { return file(kind).collisions; }

 private:
  /// The queries of one kind.
  struct File {
    File(const std::filesystem::path& folder, const std::string& name);

    verify::data::NpyWriter npy;
    verify::io::OutputFile labels;
    std::uint64_t queries = 0, collisions = 0;
  };

  [[nodiscard]] const File& file(ContactKind kind) const {
    return files_[kind == ContactKind::edge_edge ? 1 : 0];
  }

  std::array<File, 2> files_;
};

}  // namespace touchstone::simulation

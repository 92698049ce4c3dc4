#pragma once

/// \file
/// Recorded queries on disk: finding the files, determining their kind, opening them as
/// streams, in the formats of csv_dataset.hpp (also compressed by zstd) and npy_dataset.hpp. Labels
/// and times of impact may be in separate files (ground_truth_files.hpp).

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/data/query_source.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::data {

/// Options for reading a dataset.
struct DatasetOptions {
  /// The kind of all its queries; by default the path determines it.
  std::optional<AnyKind> kind = std::nullopt;
  /// Round coordinates and weights that are not doubles to the nearest double;
  /// QuerySource::rounded() counts them. A coordinate whose nearest double is infinite stays an
  /// error.
  bool round = false;
  /// Skip invalid queries instead of throwing; QuerySource::skipped() counts them.
  bool keep_going = false;
  /// With keep_going: called once for each skipped query (and for each other fault that skipped()
  /// counts), with its first error.
  std::function<void(const io::DatasetError&)> on_skip = nullptr;
};

/// Called with each file, folder or link that a search skips, and the reason.
using LeftOut = std::function<void(const io::DatasetError&)>;

/// The dataset files of the paths: a file itself, or all files *.csv, *.csv.zst and *.npy below a
/// folder, in the order of their names. Symbolic links are followed, but no folder below a path is
/// searched twice. Companions of datasets are skipped: folders called toi, mma_bool, boxes or
/// frames, and files named *_toi.csv.
/// \param on_left_out called for everything else that is skipped, and for files in those folders
/// that have a dataset's name
/// \throws DatasetError for a path that does not exist or cannot be read, or a folder without any
/// dataset.
[[nodiscard]] std::vector<std::filesystem::path> find_datasets(
    std::span<const std::filesystem::path> paths, const LeftOut& on_left_out = nullptr);

/// The kind of the queries of a file: the deepest part of the path that contains "vertex-face" or
/// "edge-edge" without a letter beside it, else the ending "vf" or "ee" of its name without
/// extension, after only digits ("326vf"), a separator and optional digits ("x_ee", "x-326vf") or
/// nothing, else the working directory's parts.
/// \throws DatasetError if the path determines no kind, or both in one part.
[[nodiscard]] AnyKind kind_from_path(const std::filesystem::path& path);

/// Opens a .csv, .csv.zst, .npy or .npz file.
/// \throws DatasetError, with and without keep_going, if the file cannot be read, its kind or its
/// format is unknown, a CSV file has no queries, or a companion file cannot be read.
[[nodiscard]] std::unique_ptr<QuerySource> open_dataset(const std::filesystem::path& path,
                                                        const DatasetOptions& options = {});

}  // namespace touchstone::verify::data

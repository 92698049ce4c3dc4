#pragma once

/// \file
/// Recorded queries on disk: finding the files, telling their kind, opening them as streams.
///
/// Formats: CSV with eight rows a query, each x, y and z as numbers or as numerator and denominator,
/// and perhaps a label (csv_dataset.hpp); NumPy arrays of shape (N, 8, 3) (npy_dataset.hpp). Labels and times of impact may lie in files of their own beside either
/// (ground_truth_files.hpp).

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exact/query.hpp"
#include "verify/data/dataset_error.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::data {

/// Options for reading a dataset.
struct DatasetOptions {
  /// The kind of all its queries; without it the path says it.
  std::optional<Kind> kind = std::nullopt;
  /// Accept coordinates that are no doubles, as the nearest double; QuerySource::rounded() counts
  /// them. A coordinate whose nearest double is infinite stays an error.
  bool round = false;
  /// Leave out queries that are in error instead of throwing; QuerySource::skipped() counts them.
  bool keep_going = false;
  /// With keep_going: called once for each query that is left out (and for each other fault that
  /// skipped() counts), with the first error found in it.
  std::function<void(const DatasetError&)> on_skip = nullptr;
};

/// Called with each file, folder or link that a search leaves out, and why.
using LeftOut = std::function<void(const DatasetError&)>;

/// The dataset files that the paths stand for: a file stands for itself, a folder for all files
/// *.csv and *.npy below it, in the order of their names. Symbolic links are followed, but no folder
/// below a path is searched twice. What accompanies datasets is left out: folders called toi,
/// mma_bool, boxes or frames, and files named *_toi.csv.
/// \param on_left_out called with everything else that is left out, and of files in those folders that have a
/// dataset's name
/// \throws DatasetError for a path that does not exist or cannot be read, or a folder without any
/// dataset.
[[nodiscard]] std::vector<std::filesystem::path> find_datasets(
    std::span<const std::filesystem::path> paths, const LeftOut& on_left_out = nullptr);

/// The kind of the queries of a file: the deepest part of the path that contains "vertex-face" or
/// "edge-edge" without a letter beside it, else the ending "vf" or "ee" of its name without
/// extension, where only digits ("326vf"), only a separator and digits ("x_ee", "x-326vf") or
/// nothing stands before it, else the working directory's parts.
/// \throws DatasetError if the path says none, or both in one part.
[[nodiscard]] Kind kind_from_path(const std::filesystem::path& path);

/// Opens a .csv or .npy file.
/// \throws DatasetError, with and without keep_going, if the file cannot be read, its kind or its
/// format is unknown, a CSV file has no queries, or a companion file cannot be read.
[[nodiscard]] std::unique_ptr<QuerySource> open_dataset(const std::filesystem::path& path,
                                                        const DatasetOptions& options = {});

}  // namespace touchstone::verify::data

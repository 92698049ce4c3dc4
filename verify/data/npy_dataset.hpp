#pragma once

/// \file
/// The queries of NumPy's files as a stream, joined with their companions: an array of float64 or
/// float32 in a .npy file, or in a .npz archive, where it is called `queries` or is the only array,
/// beside labels where there are any: `collides`, of N booleans. Its shape is (N, 8, 3), or, on
/// curves, that of Queries: (N, K+1, 4, 3), with weights (N, K+1, 4, 4). Coordinates and weights
/// are checked here. A file that becomes shorter ends the stream with an error, also with
/// keep_going.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "verify/data/dataset_source.hpp"
#include "verify/data/npy.hpp"

namespace touchstone::verify::data {

/// The queries of a .npy or .npz file as a stream.
class NpyDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  NpyDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override;

 private:
  struct Arrays {
    NpyArray queries;
    std::optional<NpyArray> labels;
  };

  [[nodiscard]] static Arrays open(const std::filesystem::path& path);
  void set_curves_by_extents();
  [[nodiscard]] bool at_end() override { return position_ == count_; }
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;
  /// Reads the next queries. \throws DatasetError if an array ends before.
  void fill();

  Arrays arrays_;
  std::uint64_t count_ = 0;
  std::uint64_t position_ = 0;
  /// The numbers of the block of queries that the position is in, and their labels.
  std::vector<double> block_;
  std::vector<std::uint8_t> collides_;
};

}  // namespace touchstone::verify::data

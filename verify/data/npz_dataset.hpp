#pragma once

/// \file
/// The queries of a .npz archive as a stream: `queries`, float32 or float64 of shape (N, 8, 3), and
/// their labels where there are any: `collides`, of N booleans.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "verify/data/dataset_source.hpp"
#include "verify/data/npz.hpp"

namespace touchstone::verify::data {

/// The queries of a .npz archive as a stream.
class NpzDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  NpzDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override;

 private:
  [[nodiscard]] bool at_end() override { return position_ == count_; }
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;
  /// Reads the next queries. \throws DatasetError if an array ends before.
  void fill();

  Npz archive_;
  NpzArray queries_;
  std::optional<NpzArray> labels_;
  std::uint64_t count_ = 0;
  std::uint64_t position_ = 0;
  /// The block of queries that the position is in, and their labels.
  std::vector<double> coordinates_;
  std::vector<std::uint8_t> collides_;
};

}  // namespace touchstone::verify::data

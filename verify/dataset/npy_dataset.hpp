#pragma once

/// \file
/// The queries of a .npy file as a stream, joined with their companions. Coordinates are checked
/// here; memory stays small because pages that were read are given back on the way.

#include <cstdint>
#include <filesystem>

#include "verify/dataset/dataset_source.hpp"
#include "verify/dataset/npy.hpp"

namespace touchstone::verify {

/// The queries of a .npy file as a stream.
class NpyDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  NpyDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override;

 private:
  [[nodiscard]] bool at_end() override { return position_ == file_.queries().size(); }
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;

  NpyFile file_;
  std::uint64_t position_ = 0;
};

}  // namespace touchstone::verify

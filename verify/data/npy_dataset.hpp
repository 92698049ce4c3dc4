#pragma once

/// \file
/// The queries of a .npy file as a stream, joined with their companions. Coordinates are checked
/// here. A file that becomes shorter ends the stream with an error, also with keep_going.

#include <cstdint>
#include <filesystem>

#include "verify/data/dataset_source.hpp"
#include "verify/data/npy.hpp"

namespace touchstone::verify::data {

/// The queries of a .npy file as a stream.
class NpyDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  NpyDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override;

 private:
  [[nodiscard]] bool at_end() override { return file_.position() == file_.count(); }
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;
  [[nodiscard]] const Query& read_query();

  NpyReader file_;
};

}  // namespace touchstone::verify::data

#include "verify/dataset/npy_dataset.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string_view>

namespace touchstone::verify {
namespace {

// About 3 MB between two releases: a system call a thousand queries would not be felt, this less.
constexpr std::uint64_t release_interval = 16384;

}  // namespace

NpyDataset::NpyDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), file_(path) {}

double NpyDataset::progress() const {
  return static_cast<double>(position_) / static_cast<double>(file_.queries().size());
}

DatasetSource::StoredQuery NpyDataset::read(std::uint64_t index) {
  if (position_ % release_interval == 0) file_.release_before(position_);
  const Query& query = file_.queries()[position_++];
  for (std::size_t row = 0; row < query_points; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::isfinite(query.coordinates.at(3 * row + axis))) continue;
      static constexpr std::string_view axes = "xyz";
      throw DatasetError(path(), {},
                         fmt::format("query {}, point {}, {}: not finite", index, row, axes[axis]));
    }
  }
  return {.query = query, .label = std::nullopt, .line = 0};
}

}  // namespace touchstone::verify

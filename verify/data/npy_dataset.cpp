#include "verify/data/npy_dataset.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string_view>

namespace touchstone::verify::data {
NpyDataset::NpyDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), file_(path) {}

double NpyDataset::progress() const {
  if (file_.count() == 0) return 1.0;
  return static_cast<double>(file_.position()) / static_cast<double>(file_.count());
}

DatasetSource::StoredQuery NpyDataset::read(std::uint64_t index) {
  const Query& query = read_query();
  for (std::size_t row = 0; row < query_points; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::isfinite(query.coordinates.at(3 * row + axis))) continue;
      static constexpr std::string_view axes = "xyz";
      throw io::DatasetError(
          path(), {}, fmt::format("query {}, point {}, {}: not finite", index, row, axes[axis]));
    }
  }
  return {.query = query, .label = std::nullopt, .label_position = {}};
}

const Query& NpyDataset::read_query() {
  try {
    return file_.next();
  } catch (const io::DatasetError& fault) {
    give_up(fault);
  }
}

}  // namespace touchstone::verify::data

#include "verify/data/npy_dataset.hpp"

namespace touchstone::verify::data {
NpyDataset::NpyDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), file_(path) {}

double NpyDataset::progress() const {
  if (file_.count() == 0) return 1.0;
  return static_cast<double>(file_.position()) / static_cast<double>(file_.count());
}

DatasetSource::StoredQuery NpyDataset::read(std::uint64_t index) {
  const Query& query = read_query();
  require_finite(query, index);
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

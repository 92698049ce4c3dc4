#include "verify/data/npz_dataset.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace touchstone::verify::data {
namespace {

/// Queries of a block.
constexpr std::uint64_t block_size = 512;

}  // namespace

NpzDataset::NpzDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), archive_(path), queries_(archive_, "queries") {
  constexpr std::array<std::uint64_t, 2> extents{query_points, 3};
  queries_.require_shape(3, extents, "(N, 8, 3)");
  count_ = queries_.shape()[0];
  if (!archive_.has("collides")) return;
  labels_.emplace(archive_, "collides");
  const std::array<std::uint64_t, 1> count{count_};
  labels_->require_shape(1, count, fmt::format("({})", count_));
}

double NpzDataset::progress() const {
  return count_ == 0 ? 1.0 : static_cast<double>(position_) / static_cast<double>(count_);
}

DatasetSource::StoredQuery NpzDataset::read(std::uint64_t index) {
  const std::size_t i = position_ % block_size;
  if (i == 0) fill();
  ++position_;
  StoredQuery result{.query = {}, .label = std::nullopt, .label_position = {}};
  constexpr std::size_t size = 3 * query_points;
  std::copy_n(coordinates_.begin() + static_cast<std::ptrdiff_t>(size * i), size,
              result.query.coordinates.begin());
  if (labels_) result.label = collides_[i] != 0;
  require_finite(result.query, index);
  return result;
}

void NpzDataset::fill() {
  const std::size_t count = std::min(block_size, count_ - position_);
  coordinates_.resize(3 * query_points * count);
  collides_.resize(count);
  try {
    queries_.take<double, float, double>(coordinates_, {"<f4", "<f8"});
    if (labels_) labels_->take<std::uint8_t, std::uint8_t>(collides_, {"|b1"});
  } catch (const io::DatasetError& fault) {
    give_up(fault);
  }
}

}  // namespace touchstone::verify::data

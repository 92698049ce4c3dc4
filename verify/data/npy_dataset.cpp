#include "verify/data/npy_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "verify/data/npy.hpp"

namespace touchstone::verify::data {
namespace {

/// Queries of a block, 96 KiB on straight lines: large enough to hide a system call, small enough
/// for the processor's cache.
constexpr std::uint64_t block_size = 512;
const std::string queries_name = "queries", labels_name = "collides";

/// The name of the array of queries. \throws DatasetError if it is unclear.
std::string name_of_queries(const Npz& archive) {
  if (archive.has(queries_name)) return queries_name;
  std::vector<std::string> names = archive.names();
  std::erase(names, labels_name);
  if (names.size() == 1) return names.front();
  throw io::DatasetError(
      archive.path(), {},
      fmt::format("no array \"{}\", and not a single array; the archive has: {}", queries_name,
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

NpyDataset::Arrays NpyDataset::open(const std::filesystem::path& path) {
  if (path.extension() != ".npz") return {.queries = NpyArray(path), .labels = std::nullopt};
  const Npz archive(path);
  Arrays arrays{.queries = NpyArray(archive, name_of_queries(archive)), .labels = std::nullopt};
  if (archive.has(labels_name)) arrays.labels = NpyArray(archive, labels_name);
  return arrays;
}

NpyDataset::NpyDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), arrays_(open(path)) {
  set_curves_by_extents();
  arrays_.queries.take_numbers({});  // throws unless it is of numbers
  count_ = arrays_.queries.shape()[0];
  if (count_ == 0) throw io::DatasetError(path, {}, "no queries");
  if (!arrays_.labels) return;
  const std::array<std::uint64_t, 1> count{count_};
  arrays_.labels->require_shape(1, count, fmt::format("({})", count_));
}

void NpyDataset::set_curves_by_extents() {
  const std::vector<std::uint64_t>& extents = arrays_.queries.shape();
  if (extents.size() == 3 && extents[1] == query_points && extents[2] == 3) return;
  const bool are_curves = extents.size() == 4 && extents[1] >= 2 &&
                          extents[1] <= greatest_degree + 1 && extents[2] == moving_points &&
                          (extents[3] == 3 || extents[3] == 4);
  if (!are_curves) {
    arrays_.queries.fail_for_shape(
        "(N, 8, 3), or (N, K+1, 4, 3) for curves of degree K from 1 to 8 (repeat the control point "
        "of "
        "a point at rest), or (N, K+1, 4, 4) with weights");
  }
  set_curves(extents[1] - 1, extents[3] == 4);
}

double NpyDataset::progress() const {
  return count_ == 0 ? 1.0 : static_cast<double>(position_) / static_cast<double>(count_);
}

DatasetSource::StoredQuery NpyDataset::read(std::uint64_t index) {
  const std::size_t i = position_ % block_size;
  if (i == 0) fill();
  ++position_;
  const std::size_t size = shape().numbers_of_query();
  StoredQuery result{.query = {shape(), std::span(block_).subspan(i * size, size)},
                     .label = std::nullopt,
                     .label_position = {}};
  if (arrays_.labels) result.label = collides_[i] != 0;
  require_valid(result.query, index);
  return result;
}

void NpyDataset::fill() {
  const std::size_t count = std::min(block_size, count_ - position_);
  block_.resize(count * shape().numbers_of_query());
  collides_.resize(count);
  try {
    arrays_.queries.take_numbers(block_);
    if (arrays_.labels) arrays_.labels->take<std::uint8_t, std::uint8_t>(collides_, {"|b1"});
  } catch (const io::DatasetError& fault) {
    give_up(fault);
  }
}

}  // namespace touchstone::verify::data

#include "verify/data/dataset_source.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "verify/data/ground_truth_files.hpp"

namespace touchstone::verify::data {

DatasetSource::DatasetSource(const std::filesystem::path& path, DatasetOptions options)
    : path_(path),
      name_(path.string()),
      options_(std::move(options)),
      shape_{.kind = options_.kind ? *options_.kind : kind_from_path(path)},
      ground_truth_files_(path),
      separation_(data::recorded_separation(path)) {}

std::optional<RecordedQuery> DatasetSource::next() {
  while (!ended_) {
    try {
      if (auto record = read_record()) return record;
      ended_ = true;
      ground_truth_files_.end(count_);  // They must not have more entries than there are queries.
    } catch (const io::DatasetError& fault) {
      if (!options_.keep_going) throw;
      ++skipped_;
      if (options_.on_skip) options_.on_skip(fault);
    }
  }
  return std::nullopt;
}

std::optional<RecordedQuery> DatasetSource::read_record() {
  if (at_end()) return std::nullopt;
  const std::uint64_t index = count_++;
  StoredQuery stored = read(index);
  RecordedTruth truth = ground_truth_files_.at(index);
  if (stored.label && truth.collides && *stored.label != *truth.collides) {
    throw io::DatasetError(
        path_, stored.label_position,
        "label differs from that in " + ground_truth_files_.label_path().string());
  }
  return RecordedQuery{.query = std::move(stored.query),
                       .index = index,
                       .collides = stored.label ? stored.label : truth.collides,
                       .toi = std::move(truth.toi)};
}

void DatasetSource::require_valid(const base::AnyQuery& query, std::uint64_t index) const {
  const std::span<const double> numbers = query.numbers();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool is_weight = query.shape().is_rational && i % 4 == 3;
    if (std::isfinite(numbers[i]) && (!is_weight || numbers[i] > 0.0)) continue;
    const std::size_t step = query.shape().numbers_of_point();
    static constexpr std::array<std::string_view, 4> names{"x", "y", "z", "weight"};
    throw io::DatasetError(path_, {},
                           fmt::format("query {}, point {}, {}: not {}finite", index, i / step,
                                       names.at(i % step), is_weight ? "positive and " : ""));
  }
}

void DatasetSource::give_up(const io::DatasetError& fault) {
  ended_ = true;
  throw io::DatasetError(fault);
}

}  // namespace touchstone::verify::data

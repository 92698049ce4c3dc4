#include "verify/data/dataset_source.hpp"

#include <utility>

#include "verify/data/separation_file.hpp"

namespace touchstone::verify::data {

DatasetSource::DatasetSource(const std::filesystem::path& path, DatasetOptions options)
    : path_(path),
      name_(path.string()),
      options_(std::move(options)),
      kind_(options_.kind ? *options_.kind : kind_from_path(path)),
      ground_truth_files_(path),
      separation_(data::recorded_separation(path)) {}

std::optional<RecordedQuery> DatasetSource::next() {
  while (!ended_) {
    std::optional<DatasetError> fault;
    try {
      std::optional<RecordedQuery> record = read_record();
      if (record) return record;
      ended_ = true;
    } catch (const DatasetError& error) {
      fault = error;
    }
    if (fault) {
      skip(*fault);
    } else {
      finish();
    }
  }
  return std::nullopt;
}

std::optional<RecordedQuery> DatasetSource::read_record() {
  if (at_end()) return std::nullopt;
  const std::uint64_t index = count_++;
  const StoredQuery stored = read(index);
  RecordedTruth truth = ground_truth_files_.at(index);
  if (stored.label && truth.collides && *stored.label != *truth.collides) {
    throw DatasetError(path_, stored.label_position,
                       "label differs from that in " + ground_truth_files_.label_path().string());
  }
  return RecordedQuery{.query = stored.query,
                       .index = index,
                       .collides = stored.label ? stored.label : truth.collides,
                       .toi = std::move(truth.toi)};
}

void DatasetSource::give_up(const DatasetError& fault) {
  ended_ = true;
  throw DatasetError(fault);
}

/// Ground truth files must not have more entries than there are queries.
void DatasetSource::finish() {
  for (const DatasetError& fault : ground_truth_files_.beyond(count_)) skip(fault);
}

void DatasetSource::skip(const DatasetError& fault) {
  if (!options_.keep_going) throw fault;
  ++skipped_;
  if (options_.on_skip) options_.on_skip(fault);
}

}  // namespace touchstone::verify::data

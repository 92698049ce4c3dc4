#pragma once

/// \file
/// Common parts of the streams of all dataset formats.
///
/// A format only reports whether there is another query and reads it. The base class numbers the
/// queries, joins them with their companion files and, with keep_going, skips invalid ones. If a
/// format no longer knows the boundaries of queries, the rest of the file is skipped. Companions
/// are read by number, so a skipped query does not shift the labels of the others.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "verify/data/dataset.hpp"
#include "verify/data/ground_truth_files.hpp"
#include "verify/data/query_source.hpp"

namespace touchstone::verify::data {

/// Base of the streams of all formats.
class DatasetSource : public QuerySource {
 public:
  [[nodiscard]] const std::string& name() const final { return name_; }
  [[nodiscard]] AnyShape shape() const final { return shape_; }
  [[nodiscard]] std::optional<RecordedQuery> next() final;
  [[nodiscard]] std::uint64_t skipped() const final { return skipped_; }
  [[nodiscard]] Separation recorded_separation() const final { return separation_; }

 protected:
  /// A query with the truth that the file itself records.
  struct StoredQuery {
    base::AnyQuery query;
    std::optional<bool> label;
    /// The position of the first label.
    io::FilePosition label_position;
  };

  /// \throws DatasetError if the kind is unknown, or a companion file or the separation's cannot be
  /// read.
  DatasetSource(const std::filesystem::path& path, DatasetOptions options);

  /// Ends the stream with this error, with and without keep_going: for a fault after which the
  /// place of the next query is unknown. The rest of the companions is ignored.
  [[noreturn]] void give_up(const io::DatasetError& fault);

  /// Its queries are on such curves; on straight lines unless this is called.
  void set_curves(std::size_t degree, bool is_rational) {
    shape_.degree = degree;
    shape_.is_rational = is_rational;
  }

  /// \throws DatasetError naming the first coordinate of query `index` that is not finite, or the
  /// first weight that is not positive and finite.
  void require_valid(const base::AnyQuery& query, std::uint64_t index) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const DatasetOptions& options() const { return options_; }

 private:
  /// True if no query is left.
  [[nodiscard]] virtual bool at_end() = 0;
  /// The next query, number `index`. Consumes it also if it throws.
  [[nodiscard]] virtual StoredQuery read(std::uint64_t index) = 0;

  [[nodiscard]] std::optional<RecordedQuery> read_record();

  std::filesystem::path path_;
  std::string name_;
  DatasetOptions options_;
  AnyShape shape_;
  GroundTruthFiles ground_truth_files_;
  Separation separation_;
  std::uint64_t count_ = 0;
  std::uint64_t skipped_ = 0;
  bool ended_ = false;
};

}  // namespace touchstone::verify::data

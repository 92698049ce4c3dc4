#pragma once

/// \file
/// Recorded truth beside a dataset: labels in <name>_mma_bool.json, times of impact in
/// <name>_toi.csv (the header "query,toi", then a line for each query that has one). ToiWriter
/// writes the latter.
///
/// Each line of times has the number of its query, so a faulty one costs one query. Damaged labels,
/// which are read whole, are an error of the dataset.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/query.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {

/// Labels from a flat JSON array of true, false, 1 and 0, one for each query.
class Labels {
 public:
  /// \throws DatasetError if the file cannot be read or is no such array.
  explicit Labels(std::filesystem::path path);

  /// The label of a query. \throws DatasetError if there is none.
  [[nodiscard]] bool at(std::uint64_t index) const;

  /// \throws DatasetError if there are more labels than that.
  void end(std::uint64_t count) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::vector<bool> labels_;
};

/// Times of impact from lines "query,toi" below that header, read in step with the queries: query
/// numbers strictly ascending, possibly with gaps; decimals of any length. Columns of errors count
/// fields. After an error it goes on with the next line.
class ToiReader {
 public:
  /// \throws DatasetError if the file cannot be read or has another header.
  explicit ToiReader(std::filesystem::path path);

  /// The time of impact of a query, if it has one; numbers must ascend from call to call.
  /// \throws DatasetError if its line, or one that is read on the way to it, is invalid.
  [[nodiscard]] std::optional<exact::Rational> at(std::uint64_t index);

  /// \throws DatasetError if an entry of a later query or an invalid line follows the entries of
  /// that many queries.
  void end(std::uint64_t count);

 private:
  struct Entry {
    std::uint64_t query;
    std::string decimal;
    std::uint64_t line;
  };

  /// Advances entry_ to the first one of query `index` or later; false if there is none.
  bool seek(std::uint64_t index);
  [[nodiscard]] Entry read_entry();

  io::LineReader lines_;
  std::optional<Entry> entry_;
};

/// The ground truth of a query that files beside the dataset record.
struct RecordedTruth {
  std::optional<bool> collides;
  std::optional<exact::Rational> toi;
};

/// The name of a dataset without its extension, also without that of a compressed one.
[[nodiscard]] std::string dataset_stem(const std::filesystem::path& dataset);

/// The existing companion files of a dataset, including that of its separation.
[[nodiscard]] std::vector<std::filesystem::path> find_ground_truth_files(
    const std::filesystem::path& dataset);

/// The companion files that a dataset has: of <dir>/<name>.csv the first that exists of
/// <dir>/../mma_bool/<name>_mma_bool.json, <dir>/mma_bool/<name>_mma_bool.json and
/// <dir>/<name>_mma_bool.json, and likewise toi/<name>_toi.csv.
class GroundTruthFiles {
 public:
  /// \throws DatasetError if labels exist but cannot be read, or the header of times.
  explicit GroundTruthFiles(const std::filesystem::path& dataset);

  /// The recorded ground truth of a query; numbers must ascend from call to call.
  /// \throws DatasetError if the record cannot be read.
  [[nodiscard]] RecordedTruth at(std::uint64_t index);

  /// \throws DatasetError if a file has more entries than those of that many queries.
  void end(std::uint64_t count);

  /// The file of the labels, empty if there is none.
  [[nodiscard]] std::filesystem::path label_path() const;

 private:
  std::optional<Labels> labels_;
  std::optional<ToiReader> tois_;
};

// ---- Writing ------------------------------------------------------------------------------------

/// A rational as a decimal such as "2.5E-1", rounded to the nearest of `significant_digits` > 0
/// digits, ties away from zero.
[[nodiscard]] std::string to_decimal(const exact::Rational& value, unsigned significant_digits);

/// Significant digits of a time of impact whose decimal cannot be exact.
inline constexpr unsigned rounded_digits = 60;

/// A rational as a decimal: all digits if the denominator is a power of two, else rounded_digits.
[[nodiscard]] std::string to_decimal(const exact::Rational& value);

/// Writes a toi companion (<dir>/toi/<name>_toi.csv beside <dir>/<name>.csv).
class ToiWriter {
 public:
  /// \throws DatasetError if no file can be made there.
  explicit ToiWriter(std::filesystem::path path);

  /// Appends the time of impact of a query.
  /// \throws DatasetError if it cannot be written.
  /// \throws std::invalid_argument if the query's number is not above that of the call before.
  void write(std::uint64_t query, const exact::Rational& toi);

  /// Completes the file and gives it its name; without this call there is no file.
  /// \throws DatasetError if it cannot be written.
  void close() { file_.close(); }

 private:
  io::OutputFile file_;
  std::optional<std::uint64_t> last_query_;
};

// The file with the separation of the recorded answers of a dataset: `separation.json`,
// {"min_separation": "0x1.5798ee2308c3ap-27", "norm": "l2"}, in the dataset's folder or the one
// above it. Without one the separation is 0.

/// The finite double ≥ 0 of the text, decimal or hexadecimal as for strtod; empty if it is none, or
/// so small that it would become 0.
[[nodiscard]] std::optional<double> distance_from_text(const std::string& text);

/// The file of a dataset: of <dir>/<name>.csv the first that exists of <dir>/separation.json and
/// <dir>/../separation.json.
[[nodiscard]] std::optional<std::filesystem::path> find_separation_file(
    const std::filesystem::path& dataset);

/// \throws DatasetError if it cannot be read, or is not an object of these two keys, once each.
[[nodiscard]] Separation read_separation(const std::filesystem::path& path);

/// The separation of the recorded answers of a dataset. \throws DatasetError as above.
[[nodiscard]] Separation recorded_separation(const std::filesystem::path& dataset);

/// Writes the file into the folder. \throws DatasetError if it cannot be written.
void write_separation(const std::filesystem::path& folder, const Separation& separation);

}  // namespace touchstone::verify::data

#pragma once

/// \file
/// Recorded truth beside a dataset: labels in <name>_mma_bool.json, times of impact in
/// <name>_toi.csv (the header "query,toi", then a line for each query that has one). ToiWriter
/// writes the latter.
///
/// Both are read as streams in step with the queries: entries are requested by ascending number,
/// and earlier ones are skipped. If the place of the next entry is certain (`null` in place of a
/// label, a malformed decimal), a fault concerns one query. After any other fault the query of an
/// entry is unknown: from there on every query has the same error.

#include <array>
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

/// Labels from a flat JSON array of true, false, 1 and 0, one for each query. Columns of errors
/// count the bytes of a line. The JSON library's parser stops at the first word that is not JSON
/// and does not read in step with the queries; here a wrong word invalidates the label of one
/// query.
class LabelReader {
 public:
  /// \throws DatasetError if the file cannot be read or does not begin with '['.
  explicit LabelReader(std::filesystem::path path);

  /// The label of a query; numbers must ascend from call to call.
  /// \throws DatasetError if there is none, or the entry is not a label.
  [[nodiscard]] bool at(std::uint64_t index);

  /// The error, if any, after the labels of `count` queries: an additional label, or invalid JSON
  /// that at() has not reported. Must be the last call.
  [[nodiscard]] std::optional<io::DatasetError> beyond(std::uint64_t count);

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  /// An element of the array: a bare word or number, not yet known to be a label.
  struct Element {
    std::string text;
    io::FilePosition position;
  };

  [[nodiscard]] std::optional<Element> next_element();
  [[nodiscard]] Element read_word();
  [[nodiscard]] int peek();
  int skip_whitespace();
  void take();
  [[noreturn]] void fail(const std::string& reason);

  io::InputFile file_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  io::FilePosition position_{.line = 1, .column = 1};
  std::uint64_t elements_ = 0;
  bool closed_ = false;
  std::optional<io::DatasetError> broken_;
};

/// Times of impact from lines "query,toi" below that header: query numbers strictly ascending,
/// possibly with gaps; decimals of any length. Columns of errors count fields.
class ToiReader {
 public:
  /// \throws DatasetError if the file cannot be read or has another header.
  explicit ToiReader(std::filesystem::path path);

  /// The time of impact of a query, if it has one; numbers must ascend from call to call.
  /// \throws DatasetError if the entry is not a time, or the file is invalid before it.
  [[nodiscard]] std::optional<exact::Rational> at(std::uint64_t index);

  /// The error, if any, after the entries of `count` queries: an entry of a later query, or an
  /// invalid line that at() has not reported. Must be the last call.
  [[nodiscard]] std::optional<io::DatasetError> beyond(std::uint64_t count);

 private:
  struct Entry {
    std::uint64_t query;
    std::string decimal;
    std::uint64_t line;
  };

  /// Advances entry_ to the first one of query `index` or later.
  void seek(std::uint64_t index);
  [[nodiscard]] std::optional<Entry> next_entry();
  [[noreturn]] void fail(io::FilePosition position, const std::string& reason) const;

  io::LineReader lines_;
  std::optional<Entry> entry_;
  bool ended_ = false;
  std::optional<io::DatasetError> broken_;
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
  /// \throws DatasetError if a companion exists but its beginning cannot be read.
  explicit GroundTruthFiles(const std::filesystem::path& dataset);

  /// The recorded ground truth of a query; numbers must ascend from call to call.
  /// \throws DatasetError if the record cannot be read.
  [[nodiscard]] RecordedTruth at(std::uint64_t index);

  /// The errors after the entries of `count` queries, at most one for each file.
  [[nodiscard]] std::vector<io::DatasetError> beyond(std::uint64_t count);

  /// The file of the labels, empty if there is none.
  [[nodiscard]] std::filesystem::path label_path() const;

 private:
  std::optional<LabelReader> labels_;
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

#pragma once

/// \file
/// The CSV formats of the public benchmarks: eight rows for each query, in the order of
/// Query; a row contains x, y and z, and optionally a label, 1 for a collision, the same on all
/// eight rows.
///
///     columns  a row                                               e.g.
///     6        numerator, denominator of x, of y and of z          the 2023 benchmark
///     7        the same and the label                              the 2021 benchmark
///     3        x, y and z                                          spreadsheets, NumPy's savetxt
///     4        the same and the label
///
/// Queries on curves have a first line of their shape (touchstone/query.hpp): `degree,K`, or
/// `rational,K` for rational curves, with K from 1 to 8. A query then has 4 (K+1) rows, the four
/// points at each control point from t=0 to t=1. A row of a rational curve ends with the weight,
/// also as a number or as numerator and denominator, before the label: 4, 5, 8 or 9 columns.
/// Without that line it is `degree,1`.
///
/// Each number is an integer or a decimal (coordinate_text.hpp; newer data has a decimal over 1).
/// Labels may also be in a separate file (ground_truth_files.hpp). Fields may be quoted. A header
/// line with a name for each column, which is ignored, may precede the first row; blank lines, the
/// header and the line of the shape may be repeated between two queries.
///
/// Only counting assigns rows to queries. A row with an invalid number, or a weight that is not
/// positive, invalidates its query. After
/// a line that is not a row (blank or a header inside a query, another number of columns, or no
/// number), or after labels that differ inside a query, the boundaries of queries are unknown, and
/// the rest of the file is skipped, so that no query is composed of two. (A missing or additional
/// row without other signs appears only at the end, as a truncated query.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "verify/data/dataset_source.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {

/// The queries of a CSV file as a stream.
class CsvDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  CsvDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override { return lines_.progress(); }
  [[nodiscard]] std::uint64_t rounded() const override { return rounded_; }

 private:
  static constexpr std::size_t most_columns = 9;

  /// The rows of the current query so far.
  struct Rows {
    StoredQuery query;
    std::uint64_t rounded;
  };

  [[nodiscard]] bool at_end() override;
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;

  [[nodiscard]] bool is_header(const io::Line& line);
  /// True if the fields are a line of a shape, which it takes over from the file's first line.
  [[nodiscard]] bool take_shape(const io::Line& line, std::size_t count);
  /// True if rows of queries may have this number of columns.
  [[nodiscard]] bool is_format(std::size_t columns) const;
  [[nodiscard]] std::size_t rows_of_query() const { return moving_points * (shape().degree + 1); }
  void split_row(const io::Line& line);
  /// Return the fault of a row that invalidates its query, if any.
  [[nodiscard]] std::optional<io::DatasetError> read_label(const io::Line& line, Rows& rows);
  [[nodiscard]] std::optional<io::DatasetError> read_numbers(const io::Line& line, std::size_t row,
                                                             Rows& rows) const;
  /// Counted from 0; without the spaces around it.
  [[nodiscard]] std::string_view field(std::size_t column) const;
  [[nodiscard]] io::DatasetError error(const io::Line& line, std::size_t column,
                                       const std::string& reason) const;
  /// Ends the stream at a line after which rows cannot be counted.
  [[noreturn]] void lose_count(const io::Line& line, std::size_t column, const std::string& reason);

  io::LineReader lines_;
  /// The first line of the next query, if at_end() has read it.
  std::optional<io::Line> ahead_;
  /// The lines of the shape and of the names of the columns, each empty if the file has none.
  std::string shape_line_;
  std::string header_;
  std::optional<std::size_t> columns_;
  /// The position of the current line.
  std::array<std::string, most_columns> fields_;
  std::uint64_t rounded_ = 0;
};

/// The eight rows of a query in the 2021 format, with its label: integers in lowest terms, LF, no
/// spaces. Without a label the rows have six columns. On curves, a line of the shape and the rows.
/// \throws std::invalid_argument if a number is not finite.
[[nodiscard]] std::string csv_rows(const base::AnyQuery& query, std::optional<bool> collides);

/// Writes files of such rows.
class CsvWriter {
 public:
  /// \throws DatasetError if no file can be made there.
  explicit CsvWriter(std::filesystem::path path);

  /// Appends a query with its label: true for a collision. Without a label, which must then hold
  /// for all queries, the rows have no column of labels. \pre all queries are of one shape
  /// \throws DatasetError if it cannot be written.
  /// \throws std::invalid_argument if a number is not finite; nothing is written then.
  void write(const base::AnyQuery& query, std::optional<bool> collides);

  /// Completes the file and gives it its name; without this call there is no file.
  /// \throws DatasetError if it cannot be written.
  void close() { file_.close(); }

 private:
  io::OutputFile file_;
  bool is_empty_ = true;
};

}  // namespace touchstone::verify::data

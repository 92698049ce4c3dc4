#pragma once

/// \file
/// The CSV formats of the public benchmarks: eight rows a query, in the order of Query; a row holds
/// x, y and z, and after them perhaps a label, 1 if they collide, the same on all eight rows.
///
///     columns  a row                                               e.g.
///     6        numerator, denominator of x, of y and of z          the 2023 benchmark
///     7        the same and the label                              the 2021 benchmark
///     3        x, y and z                                          spreadsheets, NumPy's savetxt
///     4        the same and the label
///
/// Each number is an integer or a decimal (coordinate_text.hpp; newer data has a decimal over 1).
/// Labels may also lie elsewhere (ground_truth_files.hpp). Fields may stand in quotes. Before the first row
/// there may be a header line, as many names as there are columns, which are not looked at, and
/// between two queries blank lines and the header again.
///
/// Which query a row belongs to is known by counting only. A row with a faulty number costs its
/// query. A line that is no row (blank or a header inside a query, of another number of columns, or
/// without any number) may stand for a row or not, and labels that differ inside a query say that a
/// row is missing or one too many: behind these nothing tells where queries begin, and the rest of
/// the file is left out, so that no query is ever put together of two. (A row missing or one too
/// many that leaves no other trace shows at the end only, as a truncated query.)

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
  static constexpr std::size_t most_columns = 7;

  /// The rows of one query so far.
  struct Rows {
    StoredQuery query;
    std::uint64_t rounded;
  };

  [[nodiscard]] bool at_end() override;
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;

  [[nodiscard]] bool is_header(std::string_view line);
  void split_row(const io::Line& line);
  /// Return the fault of a row that costs its query, if there is one.
  [[nodiscard]] std::optional<DatasetError> read_label(const io::Line& line, Rows& rows);
  [[nodiscard]] std::optional<DatasetError> read_point(const io::Line& line, std::size_t row,
                                                       Rows& rows) const;
  /// Counted from 0; without the spaces around it.
  [[nodiscard]] std::string_view field(std::size_t column) const;
  [[nodiscard]] DatasetError error(const io::Line& line, std::size_t column,
                                   const std::string& reason) const;
  /// Gives up at a line behind which rows cannot be counted.
  [[noreturn]] void lose_count(const io::Line& line, std::size_t column, const std::string& reason);

  io::LineReader lines_;
  /// The first line of the next query, if at_end() has come upon it.
  std::optional<io::Line> ahead_;
  /// The file's, empty if it has none.
  std::string header_;
  std::optional<std::size_t> columns_;
  /// Of the line at hand.
  std::array<std::string, most_columns> fields_;
  std::uint64_t rounded_ = 0;
};

/// The eight rows of a query in the 2021 format, with its label: integers in lowest terms, LF, no
/// spaces. Without a label the rows have six columns.
/// \throws std::invalid_argument if a coordinate is not finite.
[[nodiscard]] std::string csv_rows(const Query& query, std::optional<bool> collides);

/// Writes files of such rows.
class CsvWriter {
 public:
  /// \throws DatasetError if no file can be made there.
  explicit CsvWriter(std::filesystem::path path);

  /// Appends a query with its label: do they collide. Without one the rows have six columns, which
  /// must then be so for all queries.
  /// \throws DatasetError if it cannot be written.
  /// \throws std::invalid_argument if a coordinate is not finite; nothing is written then.
  void write(const Query& query, std::optional<bool> collides);

  /// Completes the file and gives it its name; without this call there is no file.
  /// \throws DatasetError if it cannot be written.
  void close() { file_.close(); }

 private:
  io::OutputFile file_;
};

}  // namespace touchstone::verify::data

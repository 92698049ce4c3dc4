#pragma once

/// \file
/// The CSV formats of the public benchmarks: eight rows a query, in the order of Query; a row holds
/// x, y and z as numerator, denominator pairs of integers, and in the 2021 format (seven columns) a
/// label, 1 if they collide, the same on all eight rows. The 2023 format (six columns) has its
/// labels elsewhere (companions.hpp).
///
/// Rows are counted, never resynchronised: query i is made of the lines 8i+1 to 8i+8 whatever
/// stands in them, so a faulty row costs its query and no other. (A row missing or one too many
/// puts all that follow out of step; nothing in the format tells the two cases apart.) The number
/// of columns is that of the first row; if the whole first query is left out for an error, of the
/// next one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "verify/dataset/dataset_source.hpp"
#include "verify/dataset/input_file.hpp"
#include "verify/dataset/output_file.hpp"

namespace touchstone::verify {

/// The queries of a CSV file as a stream.
class CsvDataset final : public DatasetSource {
 public:
  /// \throws DatasetError as open_dataset does.
  CsvDataset(const std::filesystem::path& path, const DatasetOptions& options);

  [[nodiscard]] double progress() const override { return lines_.progress(); }
  [[nodiscard]] std::uint64_t rounded() const override { return rounded_; }

 private:
  static constexpr std::size_t coordinate_columns = 6;
  static constexpr std::size_t labelled_columns = 7;

  /// The fields of a line; only the first seven are kept.
  struct Fields {
    std::array<std::string_view, labelled_columns> text;
    std::size_t count;
  };

  /// What the rows of one query add up to.
  struct Rows {
    StoredQuery query;
    std::size_t columns;
    std::uint64_t rounded;
  };

  [[nodiscard]] bool at_end() override { return lines_.at_end(); }
  [[nodiscard]] StoredQuery read(std::uint64_t index) override;

  [[nodiscard]] static Fields split(std::string_view line);
  void read_row(const Line& line, std::size_t row, Rows& rows) const;
  void check_columns(const Line& line, const Fields& fields, Rows& rows) const;
  void read_point(const Line& line, const Fields& fields, std::size_t row, Rows& rows) const;
  void read_label(const Line& line, const Fields& fields, Rows& rows) const;
  [[nodiscard]] DatasetError error(const Line& line, std::size_t column,
                                   const std::string& reason) const;

  LineReader lines_;
  std::optional<std::size_t> columns_;
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
  OutputFile file_;
};

}  // namespace touchstone::verify

#include "verify/dataset/csv_dataset.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "verify/dataset/coordinate_text.hpp"

namespace touchstone::verify {

CsvDataset::CsvDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), lines_(path) {
  if (lines_.at_end()) throw DatasetError(path, {}, "no queries");
}

DatasetSource::StoredQuery CsvDataset::read(std::uint64_t) {
  Rows rows{.query = {}, .columns = columns_.value_or(0), .rounded = 0};
  std::optional<DatasetError> fault;
  std::uint64_t last_line = 0;
  for (std::size_t row = 0; row < query_points; ++row) {
    const std::optional<Line> line = lines_.next();
    if (!line) {
      if (!fault) {
        fault.emplace(path(), FilePosition{.line = last_line},
                      fmt::format("truncated query: {} of {} rows", row, query_points));
      }
      break;
    }
    last_line = line->number;
    if (fault) continue;
    try {
      read_row(*line, row, rows);
    } catch (const DatasetError& row_fault) {
      fault = row_fault;
    }
  }
  if (fault) throw DatasetError(*fault);
  columns_ = rows.columns;
  rounded_ += rows.rounded;
  return rows.query;
}

void CsvDataset::read_row(const Line& line, std::size_t row, Rows& rows) const {
  if (line.too_long) throw error(line, 0, "line longer than 1 MiB");
  if (trimmed(line.text).empty()) throw error(line, 0, "blank line before the end of the file");
  if (row == 0) rows.query.line = line.number;
  const Fields fields = split(line.text);
  check_columns(line, fields, rows);
  read_point(line, fields, row, rows);
  if (rows.columns == labelled_columns) read_label(line, fields, rows);
}

CsvDataset::Fields CsvDataset::split(std::string_view line) {
  Fields fields{.text = {}, .count = 0};
  for (std::size_t begin = 0; begin <= line.size(); ++fields.count) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    if (fields.count < fields.text.size()) {
      fields.text.at(fields.count) = trimmed(line.substr(begin, end - begin));
    }
    begin = end + 1;
  }
  return fields;
}

void CsvDataset::check_columns(const Line& line, const Fields& fields, Rows& rows) const {
  if (rows.columns == 0) {
    if (fields.count != coordinate_columns && fields.count != labelled_columns) {
      throw error(line, 0,
                  fmt::format("{} columns, expected {} or {}", fields.count, coordinate_columns,
                              labelled_columns));
    }
    rows.columns = fields.count;
  }
  if (fields.count != rows.columns) {
    throw error(line, 0,
                fmt::format("{} columns, expected {} as before", fields.count, rows.columns));
  }
}

void CsvDataset::read_point(const Line& line, const Fields& fields, std::size_t row,
                            Rows& rows) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t numerator_column = 2 * axis + 1;
    try {
      const ParsedCoordinate coordinate =
          parse_coordinate(fields.text.at(2 * axis), fields.text.at(2 * axis + 1));
      if (!coordinate.exact && !options().round) {
        throw error(line, numerator_column, "not exactly a double (--round accepts the nearest)");
      }
      if (!coordinate.exact) ++rows.rounded;
      rows.query.query.at(row / moving_points, row % moving_points, axis) = coordinate.value;
    } catch (const CoordinateError& fault) {
      const bool numerator = fault.part() == CoordinateError::Part::numerator;
      throw error(line, numerator_column + (numerator ? 0 : 1), fault.what());
    }
  }
}

void CsvDataset::read_label(const Line& line, const Fields& fields, Rows& rows) const {
  const std::string_view text = fields.text.back();
  if (text != "0" && text != "1") {
    throw error(line, labelled_columns, "label must be 0 or 1: " + quote(text));
  }
  const bool label = text == "1";
  if (rows.query.label.value_or(label) != label) {
    throw error(line, labelled_columns, "label differs from that of the query's first row");
  }
  rows.query.label = label;
}

DatasetError CsvDataset::error(const Line& line, std::size_t column,
                               const std::string& reason) const {
  return {path(), {.line = line.number, .column = column}, reason};
}

std::string csv_rows(const Query& query, std::optional<bool> collides) {
  const std::string_view label = !collides ? "" : *collides ? ",1" : ",0";
  std::string text;
  for (std::size_t row = 0; row < query_points; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != 0) text += ',';
      append_coordinate(text, query.at(row / moving_points, row % moving_points, axis));
    }
    text += label;
    text += '\n';
  }
  return text;
}

CsvWriter::CsvWriter(std::filesystem::path path) : file_(std::move(path)) {}

void CsvWriter::write(const Query& query, std::optional<bool> collides) {
  file_.write(csv_rows(query, collides));
}

}  // namespace touchstone::verify

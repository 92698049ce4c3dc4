#include "verify/data/csv_dataset.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

#include "verify/io/coordinate_text.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::data {
namespace {

/// True if it can be the name of a column.
bool is_name(std::string_view text) {
  if (text.empty() || io::is_numeric(text)) return false;
  const auto first = static_cast<unsigned char>(text.front());
  return std::isalpha(first) != 0 || first == '_' || first == '#' || first >= 0x80U;
}

/// The line before the queries of a shape; none on straight lines.
std::string shape_line(const AnyShape& shape) {
  if (shape.is_straight()) return "";
  return fmt::format("{},{}\n", shape.is_rational ? "rational" : "degree", shape.degree);
}

/// The rows of a query, each with the label.
std::string rows_of(const base::AnyQuery& query, std::optional<bool> collides) {
  const std::span<const double> numbers = query.numbers();
  const std::size_t numbers_of_row = query.shape().numbers_of_point();
  const std::string_view label = !collides ? "" : *collides ? ",1" : ",0";
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    io::append_coordinate(text, numbers[i]);
    const bool ends_row = (i + 1) % numbers_of_row == 0;
    text += ends_row ? label : ",";
    if (ends_row) text += '\n';
  }
  return text;
}

}  // namespace

CsvDataset::CsvDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), lines_(path) {
  if (CsvDataset::at_end()) throw io::DatasetError(path, {}, "no queries");
}

/// Skips blank lines and headers between two queries.
bool CsvDataset::at_end() {
  while (!ahead_) {
    ahead_ = lines_.next();
    if (!ahead_) return true;
    if (io::trimmed(ahead_->text).empty() || is_header(*ahead_)) ahead_.reset();
  }
  return false;
}

/// True if the line, which is between two queries or before the first, is a header of the file.
bool CsvDataset::is_header(const io::Line& line) {
  const std::string_view text = line.text;
  if (!text.empty() && (text == header_ || text == shape_line_)) return true;
  if (columns_ || io::is_numeric(io::trimmed(text))) return false;
  const io::CsvSplit split = io::split_csv(text, fields_);
  if (split.fault != io::CsvSplit::Fault::none) return false;
  if (shape_line_.empty() && take_shape(line, split.count)) return true;
  if (!is_format(split.count)) return false;
  for (std::size_t column = 0; column < split.count; ++column) {
    if (!is_name(field(column))) return false;
  }
  columns_ = split.count;
  header_ = text;
  return true;
}

bool CsvDataset::take_shape(const io::Line& line, std::size_t count) {
  const bool is_rational = field(0) == "rational";
  if (count != 2 || (!is_rational && field(0) != "degree")) return false;
  const auto degree = io::number_from_text<std::size_t>(field(1));
  if (!degree) throw error(line, 2, "the degree must be a whole number: " + io::quote(field(1)));
  try {
    require_degree(*degree);
  } catch (const std::invalid_argument& reason) {
    throw error(line, 2, reason.what());
  }
  set_curves(*degree, is_rational);
  shape_line_ = line.text;
  return true;
}

bool CsvDataset::is_format(std::size_t columns) const {
  const std::size_t numbers = shape().numbers_of_point();
  return columns == numbers || columns == numbers + 1 || columns == 2 * numbers ||
         columns == 2 * numbers + 1;
}

DatasetSource::StoredQuery CsvDataset::read(std::uint64_t) {
  Rows rows{.query = {.query = {shape(), std::vector<double>(shape().numbers_of_query())},
                      .label = std::nullopt,
                      .label_position = {}},
            .rounded = 0};
  std::optional<io::DatasetError> fault;
  std::uint64_t last_line = 0;
  for (std::size_t row = 0; row < rows_of_query(); ++row) {
    const std::optional<io::Line> line =
        ahead_ ? std::exchange(ahead_, std::nullopt) : lines_.next();
    if (!line) {
      if (fault) break;
      throw io::DatasetError(
          path(), {.line = last_line},
          fmt::format("truncated query: {} of {} rows; if a row is missing further "
                      "up, later queries were composed of two",
                      row, rows_of_query()));
    }
    last_line = line->number;
    split_row(*line);
    // The labels of all rows, for they tell whether these are the rows of one query.
    std::optional<io::DatasetError> label_fault = read_label(*line, rows);
    if (!fault) fault = read_numbers(*line, row, rows);
    if (!fault) fault = std::move(label_fault);
  }
  if (fault) throw io::DatasetError(*fault);
  rounded_ += rows.rounded;
  return rows.query;
}

/// Splits the line into fields_. Gives up if it is not a row.
void CsvDataset::split_row(const io::Line& line) {
  if (io::trimmed(line.text).empty()) lose_count(line, 0, "blank line inside a query");
  const io::CsvSplit split = io::split_csv(line.text, fields_);
  if (split.fault != io::CsvSplit::Fault::none) {
    lose_count(line, split.count, "malformed quoted field");
  }
  if (!columns_ && !is_format(split.count)) {
    const std::size_t numbers = shape().numbers_of_point();
    lose_count(line, 0,
               fmt::format("{} columns, expected {}, {}, {} or {}", split.count, numbers,
                           numbers + 1, 2 * numbers, 2 * numbers + 1));
  }
  if (split.count != columns_.value_or(split.count)) {
    lose_count(line, 0, fmt::format("{} columns, expected {} as before", split.count, *columns_));
  }
  const auto first = fields_.begin(), last = first + static_cast<std::ptrdiff_t>(split.count);
  if (std::none_of(first, last,
                   [](const std::string& text) { return io::is_numeric(io::trimmed(text)); })) {
    lose_count(line, 0, "no number in the line");
  }
  columns_ = split.count;
}

std::optional<io::DatasetError> CsvDataset::read_label(const io::Line& line, Rows& rows) {
  const std::size_t column = columns_.value();
  if (column % shape().numbers_of_point() == 0) return std::nullopt;
  const std::string_view text = field(column - 1);
  if (text != "0" && text != "1") {
    return error(line, column, "label must be 0 or 1: " + io::quote(text));
  }
  const bool label = text == "1";
  if (!rows.query.label) {
    rows.query.label = label;
    rows.query.label_position = {.line = line.number, .column = column};
  }
  if (rows.query.label != label) {
    lose_count(line, column, "label differs from that of the query's first row");
  }
  return std::nullopt;
}

std::optional<io::DatasetError> CsvDataset::read_numbers(const io::Line& line, std::size_t row,
                                                         Rows& rows) const {
  const std::size_t count = shape().numbers_of_point();
  const std::span<double> numbers = rows.query.query.numbers().subspan(row * count, count);
  const bool is_fraction = columns_ >= 2 * count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = is_fraction ? 2 * i : i;
    try {
      const io::ParsedCoordinate coordinate =
          io::parse_coordinate(field(column), is_fraction ? field(column + 1) : "1");
      if (!coordinate.exact && !options().round) {
        return error(line, column + 1, "not exactly a double (--round takes the nearest)");
      }
      if (!coordinate.exact) ++rows.rounded;
      if (i == 3 && coordinate.value <= 0.0) {
        return error(line, column + 1, "a weight must be positive");
      }
      numbers[i] = coordinate.value;
    } catch (const io::CoordinateError& fault) {
      const bool numerator = fault.part() == io::CoordinateError::Part::numerator;
      return error(line, column + (numerator ? 1 : 2), fault.what());
    }
  }
  return std::nullopt;
}

std::string_view CsvDataset::field(std::size_t column) const {
  return io::trimmed(fields_.at(column));
}

io::DatasetError CsvDataset::error(const io::Line& line, std::size_t column,
                                   const std::string& reason) const {
  return {path(), {.line = line.number, .column = column}, reason};
}

void CsvDataset::lose_count(const io::Line& line, std::size_t column, const std::string& reason) {
  const std::size_t rows = rows_of_query();
  give_up(
      error(line, column,
            fmt::format("{}; the rest of the file is left out, since it is unknown from here on "
                        "which {} rows are a query: mend this line",
                        reason, rows == query_points ? "eight" : std::to_string(rows))));
}

std::string csv_rows(const base::AnyQuery& query, std::optional<bool> collides) {
  return shape_line(query.shape()) + rows_of(query, collides);
}

CsvWriter::CsvWriter(std::filesystem::path path) : file_(std::move(path)) {}

void CsvWriter::write(const base::AnyQuery& query, std::optional<bool> collides) {
  const std::string rows = rows_of(query, collides);
  if (std::exchange(is_empty_, false)) file_.write(shape_line(query.shape()));
  file_.write(rows);
}

}  // namespace touchstone::verify::data

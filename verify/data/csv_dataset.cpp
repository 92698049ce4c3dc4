#include "verify/data/csv_dataset.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "verify/data/plain_rows.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/csv.hpp"

namespace touchstone::verify::data {
namespace {

bool is_format(std::size_t columns) {
  return columns == 3 || columns == 4 || columns == 6 || columns == 7;
}

/// Bytes to look for plain rows in: more than eight of them have, as a rule.
constexpr std::size_t plain_bytes = 4096;

/// True if a line certainly is neither blank nor a header.
bool begins_like_a_row(std::string_view text) {
  return !text.empty() && (text.front() == '-' || (text.front() >= '0' && text.front() <= '9'));
}

/// True if it can be the name of a column.
bool is_name(std::string_view text) {
  if (text.empty() || io::is_numeric(text)) return false;
  const auto first = static_cast<unsigned char>(text.front());
  return std::isalpha(first) != 0 || first == '_' || first == '#' || first >= 0x80U;
}

}  // namespace

CsvDataset::CsvDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), lines_(path) {
  if (CsvDataset::at_end()) throw io::DatasetError(path, {}, "no queries");
}

/// Skips blank lines and headers between two queries.
bool CsvDataset::at_end() {
  if (!ahead_ && begins_like_a_row(lines_.peek(plain_bytes))) return false;
  while (!ahead_) {
    ahead_ = lines_.next();
    if (!ahead_) return true;
    if (ahead_->too_long) break;
    if (io::trimmed(ahead_->text).empty() || is_header(ahead_->text)) ahead_.reset();
  }
  return false;
}

/// True if the line, which is between two queries or before the first, is the file's header.
bool CsvDataset::is_header(std::string_view line) {
  if (columns_ || io::is_numeric(io::trimmed(line))) return !header_.empty() && line == header_;
  const io::CsvSplit split = io::split_csv(line, fields_);
  if (split.fault != io::CsvSplit::Fault::none || !is_format(split.count)) return false;
  for (std::size_t column = 0; column < split.count; ++column) {
    if (!is_name(field(column))) return false;
  }
  columns_ = split.count;
  header_ = line;
  return true;
}

DatasetSource::StoredQuery CsvDataset::read(std::uint64_t) {
  if (columns_ && !ahead_) {
    if (const auto plain = read_plain_rows(lines_.peek(plain_bytes), *columns_, options().round)) {
      const io::FilePosition first{.line = lines_.line_number() + 1, .column = *columns_};
      lines_.skip(plain->bytes, query_points);
      rounded_ += plain->rounded;
      return {.query = plain->query, .label = plain->label, .label_position = first};
    }
  }
  Rows rows{.query = {}, .rounded = 0};
  std::optional<io::DatasetError> fault;
  std::uint64_t last_line = 0;
  for (std::size_t row = 0; row < query_points; ++row) {
    const std::optional<io::Line> line =
        ahead_ ? std::exchange(ahead_, std::nullopt) : lines_.next();
    if (!line) {
      if (fault) break;
      throw io::DatasetError(
          path(), {.line = last_line},
          fmt::format("truncated query: {} of {} rows; if a row is missing further "
                      "up, queries behind it were put together of two",
                      row, query_points));
    }
    last_line = line->number;
    split_row(*line);
    // The labels of all rows, for they tell whether these are the rows of one query.
    std::optional<io::DatasetError> label_fault = read_label(*line, rows);
    if (!fault) fault = read_point(*line, row, rows);
    if (!fault) fault = std::move(label_fault);
  }
  if (fault) throw io::DatasetError(*fault);
  rounded_ += rows.rounded;
  return rows.query;
}

/// Splits the line into fields_, or gives up if it is no row.
void CsvDataset::split_row(const io::Line& line) {
  if (line.too_long) lose_count(line, 0, "line longer than 1 MiB");
  if (io::trimmed(line.text).empty()) lose_count(line, 0, "blank line inside a query");
  const io::CsvSplit split = io::split_csv(line.text, fields_);
  if (split.fault != io::CsvSplit::Fault::none) {
    lose_count(line, split.count, "malformed quoted field");
  }
  if (!columns_ && !is_format(split.count)) {
    lose_count(line, 0, fmt::format("{} columns, expected 3, 4, 6 or 7", split.count));
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
  if (columns_ != 4 && columns_ != 7) return std::nullopt;
  const std::size_t column = columns_.value();
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

std::optional<io::DatasetError> CsvDataset::read_point(const io::Line& line, std::size_t row,
                                                       Rows& rows) const {
  const bool is_fraction = columns_ >= 6;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t column = is_fraction ? 2 * axis : axis;
    try {
      const io::ParsedCoordinate coordinate =
          io::parse_coordinate(field(column), is_fraction ? field(column + 1) : "1");
      if (!coordinate.exact && !options().round) {
        return error(line, column + 1, "not exactly a double (--round takes the nearest)");
      }
      if (!coordinate.exact) ++rows.rounded;
      rows.query.query.at(row / moving_points, row % moving_points, axis) = coordinate.value;
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
  give_up(error(line, column,
                reason +
                    "; the rest of the file is left out, since it is unknown from here on which "
                    "eight rows are a query: mend this line"));
}

std::string csv_rows(const Query& query, std::optional<bool> collides) {
  const std::string_view label = !collides ? "" : *collides ? ",1" : ",0";
  std::string text;
  for (std::size_t row = 0; row < query_points; ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != 0) text += ',';
      io::append_coordinate(text, query.at(row / moving_points, row % moving_points, axis));
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

}  // namespace touchstone::verify::data

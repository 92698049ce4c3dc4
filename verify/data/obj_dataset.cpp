#include "verify/data/obj_dataset.hpp"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "verify/io/coordinate_text.hpp"

namespace touchstone::verify::data {
namespace {

constexpr std::string_view blanks = " \t";

bool is_vertex(std::string_view line) {
  return line.size() > 1 && line.front() == 'v' && blanks.find(line[1]) != std::string_view::npos;
}

/// Takes the first word of a line.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace

ObjDataset::ObjDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), lines_(path) {
  if (ObjDataset::at_end()) throw io::DatasetError(path, {}, "no vertices");
}

bool ObjDataset::at_end() {
  while (!ahead_) {
    ahead_ = lines_.next();
    if (!ahead_) return true;
    if (!ahead_->too_long && !is_vertex(ahead_->text)) ahead_.reset();
  }
  return false;
}

DatasetSource::StoredQuery ObjDataset::read(std::uint64_t) {
  StoredQuery result{.query = {}, .label = std::nullopt, .label_position = {}};
  std::optional<io::DatasetError> fault;
  for (std::size_t row = 0; row < query_points; ++row) {
    if (at_end()) {
      give_up({path(), {}, fmt::format("truncated query: {} of {} vertices", row, query_points)});
    }
    const io::Line line = *std::exchange(ahead_, std::nullopt);
    try {
      read_point(line, row, result.query);
    } catch (const io::DatasetError& error) {
      if (!fault) fault = error;
    }
  }
  if (fault) throw io::DatasetError(*fault);
  return result;
}

void ObjDataset::read_point(const io::Line& line, std::size_t row, Query& query) {
  if (line.too_long)
    throw io::DatasetError(path(), {.line = line.number}, "line longer than 1 MiB");
  std::string_view rest = line.text.substr(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const io::FilePosition position{.line = line.number, .column = axis + 2};
    const std::string_view word = take_word(rest);
    try {
      const io::ParsedCoordinate coordinate = io::parse_coordinate(word, "1");
      if (!coordinate.exact && !options().round) {
        throw io::DatasetError(path(), position,
                               "not exactly a double (--round takes the nearest)");
      }
      if (!coordinate.exact) ++rounded_;
      query.at(row / moving_points, row % moving_points, axis) = coordinate.value;
    } catch (const io::CoordinateError& error) {
      throw io::DatasetError(path(), position, error.what());
    }
  }
}

}  // namespace touchstone::verify::data

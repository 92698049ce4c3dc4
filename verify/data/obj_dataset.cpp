#include "verify/data/obj_dataset.hpp"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "verify/io/coordinate_text.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::data {

ObjDataset::ObjDataset(const std::filesystem::path& path, const DatasetOptions& options)
    : DatasetSource(path, options), statements_(path) {
  if (ObjDataset::at_end()) throw io::DatasetError(path, {}, "no vertices");
}

bool ObjDataset::at_end() {
  try {
    while (!ahead_) {
      ahead_ = statements_.next();
      if (!ahead_) return true;
      if (ahead_->keyword != "v") ahead_.reset();
    }
  } catch (const io::DatasetError& fault) {
    give_up(fault);
  }
  return false;
}

DatasetSource::StoredQuery ObjDataset::read(std::uint64_t) {
  StoredQuery result{.query = {kind(), Query{}}, .label = std::nullopt, .label_position = {}};
  std::optional<io::DatasetError> fault;
  for (std::size_t row = 0; row < query_points; ++row) {
    if (at_end()) {
      give_up({path(), {}, fmt::format("truncated query: {} of {} vertices", row, query_points)});
    }
    const io::ObjStatement vertex = *std::exchange(ahead_, std::nullopt);
    try {
      read_point(vertex, result.query.numbers().subspan(3 * row, 3));
    } catch (const io::DatasetError& error) {
      if (!fault) fault = error;
    }
  }
  if (fault) throw io::DatasetError(*fault);
  return result;
}

void ObjDataset::read_point(const io::ObjStatement& vertex, std::span<double> point) {
  std::string_view words = vertex.words;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const io::FilePosition position{.line = vertex.line, .column = axis + 2};
    const std::string_view word = io::take_word(words);
    try {
      const io::ParsedCoordinate coordinate = io::parse_coordinate(word, "1");
      if (!coordinate.exact && !options().round) {
        throw io::DatasetError(path(), position,
                               "not exactly a double (--round takes the nearest)");
      }
      if (!coordinate.exact) ++rounded_;
      point[axis] = coordinate.value;
    } catch (const io::CoordinateError& error) {
      throw io::DatasetError(path(), position, error.what());
    }
  }
  statements_.pass_over_behind_vertex(words, vertex.line);
}

}  // namespace touchstone::verify::data

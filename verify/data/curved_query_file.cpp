#include "verify/data/curved_query_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "verify/data/npy.hpp"
#include "verify/io/coordinate_text.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"

namespace touchstone::verify::data {
namespace {

/// Rejects the first number that is not valid.
void require_valid(const std::filesystem::path& path, const CurvedQueryFile& file) {
  const CurvedQueries queries = file.queries();
  for (std::size_t i = 0; i < file.numbers.size(); ++i) {
    const double x = file.numbers[i];
    const bool is_weight = file.is_rational && i % 4 == 3;
    if (std::isfinite(x) && (!is_weight || x > 0.0)) continue;
    throw io::DatasetError(path, {},
                           fmt::format("query {} has a {}", i / queries.numbers_of_query(),
                                       is_weight ? "weight that is not positive and finite"
                                                 : "coordinate that is not finite"));
  }
}

// ---- NumPy --------------------------------------------------------------------------------------

CurvedQueryFile read_npy(const std::filesystem::path& path) {
  NpyArray array(path);
  const std::vector<std::uint64_t>& shape = array.shape();
  const bool is_straight = shape.size() == 3 && shape[1] == query_points && shape[2] == 3;
  const bool is_curved = shape.size() == 4 && shape[1] >= 1 && shape[1] <= greatest_degree + 1 &&
                         shape[2] == moving_points && (shape[3] == 3 || shape[3] == 4);
  if (!is_straight && !is_curved) {
    array.fail_for_shape("(N, K+1, 4, 3), (N, K+1, 4, 4) with weights, K up to 8, or (N, 8, 3)");
  }
  CurvedQueryFile file;
  file.degree = is_curved ? shape[1] - 1 : 1;
  file.is_rational = is_curved && shape[3] == 4;
  array.take_numbers({});  // Is it of numbers?
  file.numbers.resize(shape[0] * file.queries().numbers_of_query());
  array.take_numbers(file.numbers);
  return file;
}

// ---- CSV ----------------------------------------------------------------------------------------

class CsvReader {
 public:
  explicit CsvReader(const std::filesystem::path& path) : path_(path), lines_(path) {}

  CurvedQueryFile read() {
    read_header();
    while (const std::optional<io::Line> line = next()) {
      if (!line->text.empty()) read_row(line->text);
    }
    if (file_.numbers.size() % file_.queries().numbers_of_query() != 0) {
      fail(fmt::format("the file ends within a query, which has {} rows",
                       moving_points * (file_.degree + 1)));
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw io::DatasetError(path_, {.line = lines_.line_number()}, reason);
  }

  std::optional<io::Line> next() {
    std::optional<io::Line> line = lines_.next();
    if (line && line->too_long) fail("the line is too long");
    return line;
  }

  void read_header() {
    const std::optional<io::Line> line = next();
    std::array<std::string, 2> fields;
    const bool has_two = line && io::split_csv(line->text, fields).count == fields.size();
    constexpr std::size_t none = greatest_degree + 1;
    file_.degree = has_two ? io::number_from_text<std::size_t>(fields[1]).value_or(none) : none;
    file_.is_rational = fields[0] == "rational";
    if (file_.degree > greatest_degree || (!file_.is_rational && fields[0] != "degree")) {
      fail("the first line must be degree,K or rational,K with K from 0 to 8");
    }
  }

  void read_row(std::string_view line) {
    const std::size_t numbers = file_.queries().numbers_of_point();
    std::array<std::string, 8> fields;
    const io::CsvSplit split = io::split_csv(line, fields);
    if (split.fault != io::CsvSplit::Fault::none ||
        (split.count != numbers && split.count != 2 * numbers)) {
      fail(fmt::format("{} numbers are expected, or {} numerators and denominators", numbers,
                       numbers));
    }
    const std::size_t step = split.count / numbers;
    for (std::size_t k = 0; k < numbers; ++k) {
      try {
        const io::ParsedCoordinate x =
            io::parse_coordinate(fields.at(k * step), step == 1 ? "1" : fields.at(k * step + 1));
        if (!x.exact) fail(fmt::format("number {} is no double", k + 1));
        file_.numbers.push_back(x.value);
      } catch (const io::CoordinateError& error) {
        fail(fmt::format("number {}: {}", k + 1, error.what()));
      }
    }
  }

  const std::filesystem::path& path_;
  io::LineReader lines_;
  CurvedQueryFile file_;
};

}  // namespace

bool is_curved_query_file(const std::filesystem::path& file) {
  // The header of a pipe could not be read a second time.
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  try {
    if (file.extension() == ".npy") {
      io::InputFile input(file);
      const auto read = [&](std::span<char> buffer) { return input.read_all(buffer); };
      return read_npy_header(read).shape.size() == 4;
    }
    io::LineReader lines(file);
    const std::optional<io::Line> line = lines.next();
    return line && (line->text.starts_with("degree,") || line->text.starts_with("rational,"));
  } catch (const std::runtime_error&) {
    return false;
  }
}

CurvedQueryFile read_curved_queries(const std::filesystem::path& file) {
  CurvedQueryFile result = file.extension() == ".npy" ? read_npy(file) : CsvReader(file).read();
  require_valid(file, result);
  return result;
}

}  // namespace touchstone::verify::data

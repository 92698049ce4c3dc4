#pragma once

/// \file
/// Writes times of impact as the companion file of a dataset: the header "query,toi", then a line
/// for each query that has one.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "touchstone/number.hpp"
#include "verify/io/output_file.hpp"

namespace touchstone::verify::data {

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

}  // namespace touchstone::verify::data

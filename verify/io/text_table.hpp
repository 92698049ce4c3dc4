#pragma once

/// \file
/// Text tables with aligned columns, and the numbers in them, for all commands.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io {

struct TextColumn {
  enum class Align : std::uint8_t { left, right };

  std::string name;
  /// In characters; a column is as wide as its widest cell, and at least this.
  std::size_t least_width = 0;
  Align align = Align::right;
};

/// A column of left-aligned words.
[[nodiscard]] TextColumn word_column(std::string name, std::size_t least_width = 0);

using TextRow = std::vector<std::string>;

/// A line of column names and one for each row, with two spaces between columns.
class TextTable {
 public:
  explicit TextTable(std::vector<TextColumn> columns);

  /// \pre a cell for each column, each of one line
  void add(TextRow row);

  [[nodiscard]] std::string text() const;

 private:
  std::vector<TextColumn> columns_;
  std::vector<TextRow> rows_;  // the first has the names
};

/// The elements of several lists as one.
template <class Element>
[[nodiscard]] std::vector<Element> joined(std::initializer_list<std::vector<Element>> parts) {
  std::vector<Element> all;
  for (const std::vector<Element>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The number in a format of fmt's, such as "{:.1f}"; "-" if it is unknown (empty or NaN).
[[nodiscard]] std::string number_text(std::optional<double> number, std::string_view format);

/// An error of a time of impact: "2.50e-01", "-" if it is unknown.
[[nodiscard]] std::string error_text(double error);

}  // namespace touchstone::verify::io

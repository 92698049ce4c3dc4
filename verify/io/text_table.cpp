#include "verify/io/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone::verify::io {
namespace {

using Align = TextColumn::Align;

/// The width in characters as fmt counts them, from the padding that fmt adds.
std::size_t width_of(std::string_view text) {
  return 2 * text.size() - fmt::formatted_size("{:<{}}", text, text.size());
}

}  // namespace

TextColumn word_column(std::string name, std::size_t least_width) {
  return {.name = std::move(name), .least_width = least_width, .align = Align::left};
}

TextTable::TextTable(std::vector<TextColumn> columns) : columns_(std::move(columns)) {
  TextRow& names = rows_.emplace_back();
  for (const TextColumn& column : columns_) names.push_back(column.name);
}

void TextTable::add(TextRow row) { rows_.push_back(std::move(row)); }

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    widths.push_back(columns_[i].least_width);
    for (const TextRow& row : rows_) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string text;
  for (const TextRow& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i != 0) text += "  ";
      text += columns_[i].align == Align::left ? fmt::format("{:<{}}", row[i], widths[i])
                                               : fmt::format("{:>{}}", row[i], widths[i]);
    }
    text += '\n';
  }
  return text;
}

std::string number_text(std::optional<double> number, std::string_view format) {
  if (!number || std::isnan(*number)) return "-";
  return fmt::format(fmt::runtime(format), *number);
}

std::string error_text(double error) { return number_text(error, "{:.2e}"); }

}  // namespace touchstone::verify::io

#include "verify/io/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verify/io/number_text.hpp"
#include "verify/io/printable.hpp"

namespace touchstone::verify::io {
namespace {

constexpr char apostrophe = '\'';

/// Would a spreadsheet compute the text, but for apostrophes in front?
bool is_formula(std::string_view text) {
  static constexpr std::string_view marks = "=+-@";
  const std::size_t first = text.find_first_not_of(apostrophe);
  return first != std::string_view::npos && text.size() > 1 &&
         marks.find(text[first]) != std::string_view::npos && !number_from_text<double>(text);
}

/// Takes a field that begins with a quote from the front of the record, the comma behind it
/// excluded. Returns what is wrong with it.
CsvSplit::Fault take_quoted(std::string_view& record, std::string& field) {
  for (record.remove_prefix(1);;) {
    const std::size_t quote = record.find('"');
    if (quote == std::string_view::npos) return CsvSplit::Fault::open_quote;
    field.append(record.substr(0, quote));
    record.remove_prefix(quote + 1);
    if (!record.starts_with('"')) break;
    field += '"';
    record.remove_prefix(1);
  }
  return record.empty() || record.front() == ',' ? CsvSplit::Fault::none
                                                 : CsvSplit::Fault::text_after_quote;
}

CsvSplit::Fault take_field(std::string_view& record, std::string& field) {
  field.clear();
  if (record.starts_with('"')) return take_quoted(record, field);
  const std::size_t end = std::min(record.find(','), record.size());
  field.append(record.substr(0, end));
  record.remove_prefix(end);
  return CsvSplit::Fault::none;
}

}  // namespace

std::string csv_field(std::string_view text) {
  std::string field = printable(text);
  if (is_formula(field)) field.insert(0, 1, apostrophe);
  if (field.find_first_of(",\"") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string csv_row(const std::vector<std::string>& texts) {
  std::string row;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (i != 0) row += ',';
    row += csv_field(texts[i]);
  }
  return row + '\n';
}

std::string csv_number(double number) {
  return std::isnan(number) ? std::string() : fmt::format("{}", number);
}

std::string text_of_field(std::string_view field) {
  std::string text = printable(field);
  if (text.starts_with(apostrophe) && is_formula(text)) text.erase(0, 1);
  return text;
}

CsvSplit split_csv(std::string_view record, std::span<std::string> fields) {
  CsvSplit result;
  std::string passed_over;
  for (;;) {
    std::string& field = result.count < fields.size() ? fields[result.count] : passed_over;
    result.fault = take_field(record, field);
    ++result.count;
    if (result.fault != CsvSplit::Fault::none || record.empty()) return result;
    record.remove_prefix(1);
  }
}

}  // namespace touchstone::verify::io

#include "verify/csv.hpp"

#include <algorithm>

namespace touchstone::verify {
namespace {

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
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
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

}  // namespace touchstone::verify

#pragma once

/// \file
/// Comma-separated values by RFC 4180: a field with a comma, a quote or a line end is quoted,
/// and quotes in it are doubled.
///
/// The output is printable (printable.hpp) and contains no formulas for spreadsheets: a text that
/// begins with = + - or @ and is not a number is preceded by an apostrophe, and so is one that
/// begins with apostrophes followed by one of these.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io {

/// The text as one field: printable, not a formula, quoted if necessary.
[[nodiscard]] std::string csv_field(std::string_view text);

/// The texts as a record, with its line end.
[[nodiscard]] std::string csv_row(const std::vector<std::string>& texts);

/// A number with the digits that reproduce the double; empty for NaN.
[[nodiscard]] std::string csv_number(double number);

/// The printable text of a field without its quotes: without the apostrophe that csv_field() put
/// before a formula. Fields of other programs are made printable.
[[nodiscard]] std::string text_of_field(std::string_view field);

/// The result of split_csv.
struct CsvSplit {
  enum class Fault : std::uint8_t {
    none,
    open_quote,        ///< a quoted field does not end: the record continues in the next line
    text_after_quote,  ///< a quoted field is followed by something other than a comma
  };

  /// Fields of the record, those beyond the end of `fields` included; up to the fault if any.
  std::size_t count = 0;
  Fault fault = Fault::none;
};

/// Splits a record, given without its line end, and puts the first fields, free of their quotes,
/// into `fields`. Spaces belong to the fields. Even an empty record has one field.
[[nodiscard]] CsvSplit split_csv(std::string_view record, std::span<std::string> fields);

}  // namespace touchstone::verify::io

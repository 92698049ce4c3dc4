#pragma once

/// \file
/// Comma-separated values as RFC 4180 has them: a field with a comma, a quote or a line end in it
/// stands in quotes, and quotes in it are doubled.
///
/// The output is printable (printable.hpp), and no formula to a spreadsheet: a text that begins with
/// = + - or @ and is no number gets an apostrophe in front, and so does one that begins with
/// apostrophes and then with one of these.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::io {

/// The text as one field: printable, no formula, in quotes where it needs them.
[[nodiscard]] std::string csv_field(std::string_view text);

/// The texts as a record, with its line end.
[[nodiscard]] std::string csv_row(const std::vector<std::string>& texts,
                                  std::string_view line_end = "\n");

/// A number with as many digits as give the same double again; nothing where it is NaN.
[[nodiscard]] std::string csv_number(double number);

/// The printable text that a field, given without its quotes, stands for: without the apostrophe that
/// csv_field() put in front of a formula. Of what others wrote, the text made printable.
[[nodiscard]] std::string text_of_field(std::string_view field);

/// The result of split_csv.
struct CsvSplit {
  enum class Fault : std::uint8_t {
    none,
    open_quote,        ///< a quoted field does not end: the record goes on in the next line
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

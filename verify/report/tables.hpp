#pragma once

/// \file
/// The tables of a report: the paper's table 1 and its tables over the minimum separation, the
/// published numbers beside ours where the data are those of the paper. The page and
/// docs/results.md show the same tables.

#include <string>
#include <string_view>
#include <vector>

#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

/// A table of texts.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// The meaning of the columns of the tables below, one sentence a line of text.
[[nodiscard]] std::vector<std::string> column_meanings();

/// Table 1, one for each group and kind: a row a method with its time, that as a multiple of the
/// certified solver's on the same queries, how many queries were asked, the counts of the judge,
/// how many reached the limit of checks, and the error of the time of impact. A group named
/// "handcrafted" or "simulation" has the published numbers too.
[[nodiscard]] std::vector<Table> field_tables(const Measurements& measurements);

/// The tables over d, one for each group and kind: of `method` beside Tight-Inclusion and the
/// certified solver, in which each is judged in its own norm, and the certified solver in both.
/// Empty without measurements of the method.
[[nodiscard]] std::vector<Table> separation_tables(const Measurements& measurements,
                                                   std::string_view method);

/// The contacts that Tight-Inclusion misses with each of its filters: the contacts at t=1, a table
/// for each number of digits with a row a kind and scale; then the built-in families, a row for
/// each and kind of which one of them misses something. A column a method: how many of the
/// collisions. Empty without measurements.
[[nodiscard]] std::vector<Table> filter_tables(const Measurements& measurements);

/// The difference between the filters, for a reader of these tables.
[[nodiscard]] std::string_view filter_sentence();

/// "12.3", "0.00456", "12300": three digits, more for whole numbers from 1000; "–" for NaN.
[[nodiscard]] std::string short_number(double value);

/// "8.3 %", "0.0012 %", "100 %": two digits, or whole numbers from 100.
[[nodiscard]] std::string percent(double share);

/// As a table of Markdown, with what could be markup escaped.
[[nodiscard]] std::string to_markdown(const Table& table);

/// As RFC 4180 [rfc4180] has it, the first record being the columns.
[[nodiscard]] std::string to_csv(const Table& table);

}  // namespace touchstone::verify::report

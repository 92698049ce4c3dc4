#pragma once

/// \file
/// The texts that a page is made of, embedded when the tool is built: d3 as Debian packages it,
/// report.js, report_page.js and report_page.css from this folder, and docs/data/published.json.

#include <string_view>

namespace touchstone::verify::report {

/// The d3 library, minified, with its licence's notice at the top.
[[nodiscard]] std::string_view d3_script();

/// The numbers of published tables, with remarks on them, as JSON.
[[nodiscard]] std::string_view published_numbers();

/// The script that computes tables, figures and sentences from measurements.
[[nodiscard]] std::string_view report_script();

/// The script that writes and draws a page.
[[nodiscard]] std::string_view page_script();

/// The style of a page.
[[nodiscard]] std::string_view page_style();

}  // namespace touchstone::verify::report

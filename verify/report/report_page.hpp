#pragma once

/// \file
/// A report, or a map of stability, as one HTML page that needs nothing else: no network, no other
/// file. Its policy (Content-Security-Policy) forbids to load anything.
///
/// The page holds the measurements as JSON. In the browser report.js computes its contents from
/// them, and report_page.js writes and draws them, with d3. A report opens with its findings and
/// the first figure of time against error; tables and further figures follow. Every table and
/// figure has a link to its numbers as CSV; every table has one to itself as Markdown, every figure
/// one to itself as an SVG file. Tables are sorted by the column that the reader chooses; the first
/// column, and that of the false negatives behind it, stay in view. The page fits screens from a
/// telephone's on, and paper, and follows the reader's light or dark scheme.

#include <string>
#include <string_view>

#include "verify/report/measurement.hpp"
#include "verify/report/stability.hpp"

namespace touchstone::verify::report {

/// The page as HTML.
[[nodiscard]] std::string report_page(const Measurements& measured);

/// The map of stability as HTML: the methods that keep their promise, the worst of each hardness as
/// a table, and as figures the worst outcome, the errors of the time of impact, time and checks of
/// every cell.
/// \param command the command line that made it
[[nodiscard]] std::string stability_page(const StabilityResult& result, const std::string& command);

// The texts that a page is made of, embedded when the tool is built: d3 as Debian packages it,
// report.js, report_page.js and report_page.css from this folder, and docs/data/published.json.

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

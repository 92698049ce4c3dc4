#pragma once

/// \file
/// The rows of a benchmark as one HTML page that needs nothing else: no network, no other file. Its
/// policy (Content-Security-Policy) forbids to load anything.
///
/// The page holds the rows as JSON; in the browser bench_page.js draws them with d3: speed against
/// error, a panel for each source, and error over the level of families of growing difficulty.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace touchstone::verify::report {

/// The page as HTML. \param rows a list of rows as bench_report.hpp makes them; others, such as
/// those of whole steps, are not shown
[[nodiscard]] std::string bench_page(const nlohmann::json& rows);

// The texts that a page is made of, embedded when the tool is built: d3 as Debian packages it,
// bench_page.js and page.css.

/// The d3 library, minified, with its licence's notice at the top.
[[nodiscard]] std::string_view d3_script();

/// The script that draws a page.
[[nodiscard]] std::string_view page_script();

/// The style of a page, of this and of the view's.
[[nodiscard]] std::string_view page_style();

}  // namespace touchstone::verify::report

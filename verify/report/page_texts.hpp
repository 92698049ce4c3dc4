#pragma once

/// \file
/// The texts that a page is made of, embedded when the tool is built: d3 as Debian packages it, and
/// page.js and page.css from verify/report/page/.

#include <string_view>

namespace touchstone::verify::report {

/// The d3 library, minified, with its licence's notice at the top.
[[nodiscard]] std::string_view d3_script();

/// The script that draws the figures of a page.
[[nodiscard]] std::string_view page_script();

/// The style of a page.
[[nodiscard]] std::string_view page_style();

}  // namespace touchstone::verify::report

#pragma once

/// \file
/// A report as one HTML page that needs nothing else: no network, no other file. Its policy
/// (Content-Security-Policy) forbids to load anything.
///
/// The tables are in the page as they are; the figures are drawn by d3 in the browser from the data that
/// stand in the page. Every table and figure has a link to its numbers as CSV, inside the page too, and
/// the command that made them. It fits screens from a telephone's on, and paper, and follows the reader's
/// light or dark scheme.

#include <string>

#include "verify/report/measurement.hpp"

namespace touchstone::verify {

/// The page as HTML.
[[nodiscard]] std::string report_page(const Measurements& measurements);

}  // namespace touchstone::verify

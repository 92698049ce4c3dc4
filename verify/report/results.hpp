#pragma once

/// \file
/// The tables of a report as a document (docs/results.md), the published numbers beside ours, with
/// what the data say in sentences and why the numbers differ.

#include <string>

#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

/// The document, in Markdown.
[[nodiscard]] std::string results_document(const Measurements& measurements);

}  // namespace touchstone::verify::report

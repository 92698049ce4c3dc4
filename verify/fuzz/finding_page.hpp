#pragma once

/// \file
/// A group of findings as a page for an issue tracker, and all groups as files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "verify/fuzz/fuzz_report.hpp"
#include "verify/fuzz/standalone.hpp"

namespace touchstone::verify::fuzz {

/// Markdown for readers without knowledge of this project: the answer, the truth, the points in
/// decimal and in hexadecimal, a program that shows the fault (standalone.hpp), the certificate
/// with instructions for its check, and the command that reproduces the finding.
/// \param name of the files beside the page: NAME.cpp and NAME.cert
[[nodiscard]] std::string as_page(const FuzzReport& report, const FindingGroup& group,
                                  CallInterface interface, const std::string& name);

/// Writes into a folder, which it creates: for each group of the report, by its number and kind of
/// finding, the page, the program and the certificate if there is one (1-false_negative.md, .cpp
/// and .cert), and findings.json (fuzz_report.hpp). Returns the pages.
/// \throws DatasetError if a file cannot be written.
[[nodiscard]] std::vector<std::filesystem::path> write_pages(const FuzzReport& report,
                                                             CallInterface interface,
                                                             const std::filesystem::path& folder);

}  // namespace touchstone::verify::fuzz

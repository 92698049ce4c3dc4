#pragma once

/// \file
/// Groups of findings as pages for an issue tracker, and wrong answers as self-contained C++
/// programs, which the authors of a solver compile with their own code. Both are texts with places
/// that the JSON of the findings fills (fuzz_report.hpp).

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::verify::fuzz {

/// A C++17 program that solves a finding's simplest query, and prints the answer and the truth. Its
/// exit status is 1 if the answer is wrong as found, 0 if it is not (also if there is no crash,
/// exit, exception or hang, where that was found), and 2 if the solver cannot be called.
/// \param finding with finite coordinates, as in `findings` of to_json
/// \param calls the interface of the solver: "plugin" (touchstone/plugin.h, of a loaded library),
/// "ticcd" (the public Tight-Inclusion) or "ipc-toolkit" (the public IPC Toolkit, AdditiveCCD); if
/// empty, that of the public code of a built-in method, if there is such code, otherwise "plugin".
/// Curves are always asked about by "plugin".
[[nodiscard]] std::string as_program(const nlohmann::json& finding, std::string_view calls);

/// Writes into a folder, which it creates: for each group of the report, by its number and kind of
/// finding, the page, the program and the certificate if there is one (1-false_negative.md, .cpp
/// and .cert), and findings.json, the report. A page is Markdown for readers without knowledge of
/// this project: answer, truth, points, program, certificate, and the command that asks again.
/// Returns the pages.
/// \throws DatasetError if a file cannot be written.
[[nodiscard]] std::vector<std::filesystem::path> write_pages(const nlohmann::json& report,
                                                             std::string_view calls,
                                                             const std::filesystem::path& folder);

}  // namespace touchstone::verify::fuzz

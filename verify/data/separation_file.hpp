#pragma once

/// \file
/// The file with the separation of the recorded answers of a dataset: `separation.json`,
/// {"min_separation": "0x1.5798ee2308c3ap-27", "norm": "l2"}, in the dataset's folder or the one
/// above it. Without one the separation is 0.

#include <filesystem>
#include <optional>
#include <string>

#include "touchstone/query.hpp"

namespace touchstone::verify::data {

/// The finite double ≥ 0 of the text, decimal or hexadecimal as for strtod; empty if it is none, or
/// so small that it would become 0.
[[nodiscard]] std::optional<double> distance_from_text(const std::string& text);

/// The file of a dataset: of <dir>/<name>.csv the first that exists of <dir>/separation.json and
/// <dir>/../separation.json.
[[nodiscard]] std::optional<std::filesystem::path> find_separation_file(
    const std::filesystem::path& dataset);

/// \throws DatasetError if it cannot be read, or is not an object of these two keys, once each.
[[nodiscard]] Separation read_separation(const std::filesystem::path& path);

/// The separation of the recorded answers of a dataset. \throws DatasetError as above.
[[nodiscard]] Separation recorded_separation(const std::filesystem::path& dataset);

/// Writes the file into the folder. \throws DatasetError if it cannot be written.
void write_separation(const std::filesystem::path& folder, const Separation& separation);

}  // namespace touchstone::verify::data

#pragma once

/// \file
/// Groups of vertices: their names in a file, and which of them do not meet.

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// The groups that a text file names: the group's name of each vertex, a line each.
/// \throws DatasetError if the file cannot be read, has a blank line before its end, or other than `vertices`
/// lines.
[[nodiscard]] Groups read_groups(const std::filesystem::path& path, std::size_t vertices);

/// The groups' numbers of pairs of names. \throws std::invalid_argument naming one that no group
/// has, and those that there are.
[[nodiscard]] std::vector<std::array<std::int32_t, 2>> numbers_of(
    const Groups& groups, std::span<const std::pair<std::string, std::string>> names);

}  // namespace touchstone::verify::mesh

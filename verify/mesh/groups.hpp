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

#include "touchstone/mesh.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh {

/// The groups that a text file names: the group's name of each vertex, a line each.
/// \throws DatasetError if the file cannot be read, has a blank line before its end, or other than
/// `vertices` lines.
[[nodiscard]] Groups read_groups(const std::filesystem::path& path, std::size_t vertices);

/// The radius of each group from a text file: a line NAME,RADIUS for each group that has one.
/// \throws DatasetError if the file cannot be read, a line is no such one, or a group has two of
/// them; std::invalid_argument naming a group that there is not, and those that there are.
[[nodiscard]] std::vector<double> read_radii(const std::filesystem::path& path,
                                             const Groups& groups);

/// The separations of pairs of groups: lines NAME,NAME,DISTANCE. \throws likewise.
[[nodiscard]] std::vector<fast::GroupSeparation> read_separations(const std::filesystem::path& path,
                                                                  const Groups& groups);

/// The groups' numbers of pairs of names. \throws std::invalid_argument naming one that no group
/// has, and those that there are.
[[nodiscard]] std::vector<std::array<std::int32_t, 2>> numbers_of(
    const Groups& groups, std::span<const std::pair<std::string, std::string>> names);

}  // namespace touchstone::verify::mesh

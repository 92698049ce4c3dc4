#pragma once

/// \file
/// Which parts of a mesh do not meet, on the command line: --groups and --apart.

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fast/step.hpp"
#include "verify/cli/files.hpp"
#include "verify/mesh/mesh.hpp"

namespace touchstone::verify::cli {

struct GroupArguments {
  std::string file;
  /// Names of groups that do not meet.
  std::vector<std::pair<std::string, std::string>> apart;
};

/// Adds --groups and --apart. The arguments must live until the command line is parsed.
void add_group_options(CLI::App& command, GroupArguments& arguments);

/// The groups of a mesh that the user asked for, by their numbers.
class CollidingGroups {
 public:
  /// \param files gets the file that is read
  /// \throws std::runtime_error, std::invalid_argument or DatasetError if they cannot be used.
  CollidingGroups(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh);

  /// Refers to this object.
  [[nodiscard]] fast::CollisionGroups get() const {
    return {.of_vertices = groups_.of_vertex, .apart = apart_};
  }

 private:
  mesh::Groups groups_;
  std::vector<std::array<std::int32_t, 2>> apart_;
};

}  // namespace touchstone::verify::cli

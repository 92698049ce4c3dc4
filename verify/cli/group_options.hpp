#pragma once

/// \file
/// Collision groups on the command line: --groups and --apart, --radii and --separations.

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "touchstone/step.hpp"
#include "verify/cli/files.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::cli {

struct GroupArguments {
  std::string file;
  /// Pairs of names of groups between which collisions are ignored.
  std::vector<std::pair<std::string, std::string>> apart;
  std::string radii_file;
  std::string separations_file;

  [[nodiscard]] bool is_empty() const {
    return file.empty() && apart.empty() && radii_file.empty() && separations_file.empty();
  }
};

/// Adds --radii and --separations, the thickness of groups. As below.
void add_thickness_options(CLI::App& command, GroupArguments& arguments);

/// Adds --groups and --apart. The arguments must live until the command line is parsed.
void add_group_options(CLI::App& command, GroupArguments& arguments);

/// The requested groups of a mesh, by their numbers.
class CollidingGroups {
 public:
  /// \param files records the input file
  /// \throws std::runtime_error, std::invalid_argument or DatasetError if they cannot be used.
  CollidingGroups(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh);

  /// Refers to this object.
  [[nodiscard]] fast::CollisionGroups get() const {
    return {.of_vertices = groups_.of_vertex,
            .apart = apart_,
            .radii = radii_,
            .separations = separations_};
  }

 private:
  mesh::Groups groups_;
  std::vector<std::array<std::int32_t, 2>> apart_;
  std::vector<double> radii_;
  std::vector<fast::GroupSeparation> separations_;
};

}  // namespace touchstone::verify::cli

#include "verify/cli/group_options.hpp"

#include <cstddef>
#include <stdexcept>

#include "verify/cli/option_table.hpp"
#include "verify/mesh/groups.hpp"

namespace touchstone::verify::cli {
namespace {

/// The groups if they are needed: empty if all can collide.
mesh::Groups groups_for(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh) {
  if (!arguments.file.empty()) {
    files.add_input(arguments.file);
    return mesh::read_groups(arguments.file, static_cast<std::size_t>(mesh.vertices.rows()));
  }
  if (arguments.is_empty()) return {};
  if (!mesh.groups.error.empty()) throw std::runtime_error(mesh.groups.error);
  if (mesh.groups.names.empty()) {
    const std::string option = !arguments.apart.empty()        ? "--apart"
                               : !arguments.radii_file.empty() ? "--radii"
                                                               : "--separations";
    throw std::runtime_error(
        option + " needs groups: from names (o, g) in an OBJ file, or by --groups FILE");
  }
  return mesh.groups;
}

}  // namespace

CollidingGroups::CollidingGroups(Files& files, const GroupArguments& arguments,
                                 const mesh::Mesh& mesh)
    : groups_(groups_for(files, arguments, mesh)),
      apart_(mesh::numbers_of(groups_, arguments.apart)) {
  if (!arguments.radii_file.empty()) {
    files.add_input(arguments.radii_file);
    radii_ = mesh::read_radii(arguments.radii_file, groups_);
  }
  if (!arguments.separations_file.empty()) {
    files.add_input(arguments.separations_file);
    separations_ = mesh::read_separations(arguments.separations_file, groups_);
  }
}

void add_thickness_options(CLI::App& command, GroupArguments& arguments) {
  add_option(command, "--radii", arguments.radii_file);
  add_option(command, "--separations", arguments.separations_file);
}

void add_group_options(CLI::App& command, GroupArguments& arguments) {
  add_option(command, "--groups", arguments.file);
  add_option(command, "--apart", arguments.apart);
}

}  // namespace touchstone::verify::cli

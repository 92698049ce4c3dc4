#include "verify/cli/group_options.hpp"

#include <cstddef>
#include <stdexcept>

#include "verify/mesh/groups.hpp"

namespace touchstone::verify::cli {
namespace {

/// The groups that are needed: none where all meet.
mesh::Groups groups_for(Files& files, const GroupArguments& arguments, const mesh::Mesh& mesh) {
  if (!arguments.file.empty()) {
    files.add_input(arguments.file);
    return mesh::read_groups(arguments.file, static_cast<std::size_t>(mesh.vertices.rows()));
  }
  if (arguments.apart.empty()) return {};
  if (!mesh.groups.error.empty()) throw std::runtime_error(mesh.groups.error);
  if (mesh.groups.names.empty()) {
    throw std::runtime_error(
        "--apart needs groups: from names (o, g) in an OBJ file, or by --groups FILE");
  }
  return mesh.groups;
}

}  // namespace

CollidingGroups::CollidingGroups(Files& files, const GroupArguments& arguments,
                                 const mesh::Mesh& mesh)
    : groups_(groups_for(files, arguments, mesh)),
      apart_(mesh::numbers_of(groups_, arguments.apart)) {}

void add_group_options(CLI::App& command, GroupArguments& arguments) {
  command
      .add_option("--groups", arguments.file,
                  "The name of each vertex's group, a line each (default: o, g of an OBJ)")
      ->type_name("FILE");
  command
      .add_option("--apart", arguments.apart,
                  "Two groups that do not meet; one twice: not itself; repeatable")
      ->type_name("GROUP GROUP");
}

}  // namespace touchstone::verify::cli

#pragma once

/// \file
/// Mesh files that a test writes, and the errors of reading them.

#include <string>
#include <string_view>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::tests {

/// A folder for this test, removed with this object.
class MeshFolder : public verify::data::test::TemporaryFolder {
 public:
  /// The mesh in a file with these bytes.
  [[nodiscard]] verify::mesh::Mesh mesh(const std::string& name, std::string_view bytes) const {
    return verify::mesh::read_mesh(file(name, bytes));
  }

  /// The error of reading such a file, without the folder; "" if there is none.
  [[nodiscard]] std::string error(const std::string& name, std::string_view bytes) const {
    return error_of([&] { (void)mesh(name, bytes); });
  }

  template <class Action>
  [[nodiscard]] std::string error_of(const Action& action) const {
    const std::string error = verify::data::test::error_of(path(), action);
    return error == "no DatasetError" ? "" : error;
  }
};

/// The coordinates of a mesh's vertices, row by row.
[[nodiscard]] inline std::vector<double> coordinates(const verify::mesh::Mesh& mesh) {
  return {mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size()};
}

}  // namespace touchstone::tests

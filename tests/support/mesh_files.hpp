#pragma once

/// \file
/// Mesh files that a test writes, and the errors of reading them.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "verify/data/dataset_error.hpp"
#include "verify/mesh/mesh.hpp"

namespace touchstone::tests {

/// A folder for this test, removed with this object.
class MeshFolder {
 public:
  MeshFolder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("touchstone_mesh_") + test->test_suite_name() + "_" + test->name() + "_" +
             std::to_string(getpid()));
    std::filesystem::create_directories(path_);
  }
  MeshFolder(const MeshFolder&) = delete;
  MeshFolder& operator=(const MeshFolder&) = delete;
  MeshFolder(MeshFolder&&) = delete;
  MeshFolder& operator=(MeshFolder&&) = delete;
  ~MeshFolder() { std::filesystem::remove_all(path_); }

  /// Writes a file and returns its path.
  [[nodiscard]] std::filesystem::path file(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

  /// The mesh in a file with these bytes.
  [[nodiscard]] verify::mesh::Mesh mesh(const std::string& name, std::string_view bytes) const {
    return verify::mesh::read_mesh(file(name, bytes));
  }

  /// The error of reading such a file, without the folder; "" if there is none.
  [[nodiscard]] std::string error(const std::string& name, std::string_view bytes) const {
    return error_of(file(name, bytes));
  }

  [[nodiscard]] std::string error_of(const std::filesystem::path& path) const {
    try {
      (void)verify::mesh::read_mesh(path);
    } catch (const verify::data::DatasetError& error) {
      const std::string folder = path_.string() + "/", text = error.what();
      return text.starts_with(folder) ? text.substr(folder.size()) : text;
    }
    return "";
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The coordinates of a mesh's vertices, row by row.
[[nodiscard]] inline std::vector<double> coordinates(const verify::mesh::Mesh& mesh) {
  return {mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size()};
}

}  // namespace touchstone::tests

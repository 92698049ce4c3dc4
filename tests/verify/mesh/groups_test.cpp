#include "verify/mesh/groups.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/mesh_files.hpp"

namespace touchstone::verify::mesh::groups_test {
namespace {

using tests::MeshFolder;

TEST(ReadGroups, GivesEachVertexTheGroupOfItsLine) {
  const MeshFolder folder;
  const Groups groups =
      read_groups(folder.file("groups.txt", "cloth\n the ball\t\r\ncloth\n\n"), 3);
  EXPECT_EQ(groups.names, (std::vector<std::string>{"cloth", "the ball"}));
  EXPECT_EQ(groups.of_vertex, (std::vector<std::int32_t>{0, 1, 0}));
  EXPECT_EQ(groups.error, "");
}

TEST(ReadGroups, NeedsALineForEachVertex) {
  const MeshFolder folder;
  const auto error = [&](std::string_view text, std::size_t vertices) {
    return folder.error_of([&] { (void)read_groups(folder.file("groups.txt", text), vertices); });
  };
  EXPECT_EQ(error("a\nb\n", 2), "");
  EXPECT_EQ(
      error("a\n", 2),
      "groups.txt: 1 lines, but the mesh has 2 vertices: a group's name for each, a line each");
  EXPECT_EQ(error("a\nb\nc\n", 2),
            "groups.txt:3: a group for more than the 2 vertices of the mesh");
  EXPECT_EQ(error("a\n\nb\n", 3), "groups.txt:2: no name of a group");
}

}  // namespace
}  // namespace touchstone::verify::mesh::groups_test

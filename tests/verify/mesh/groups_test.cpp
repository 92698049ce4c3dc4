#include "verify/mesh/groups.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/mesh_files.hpp"
#include "tests/support/messages.hpp"

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

TEST(ReadRadii, AndSeparationsAreThoseOfNamedGroups) {
  const MeshFolder folder;
  const Groups groups{.names = {"cloth", "the ball", "a,b"}, .of_vertex = {0, 1, 2}, .error = ""};
  EXPECT_EQ(read_radii(folder.file("r.csv", "the ball,0.5\n\"a,b\", 1e-3\n"), groups),
            (std::vector<double>{0, 0.5, 1e-3}));
  EXPECT_EQ(read_separations(folder.file("s.csv", "\"a,b\",cloth,2\ncloth, cloth ,0\n"), groups),
            (std::vector<fast::GroupSeparation>{{{2, 0}, 2.0}, {{0, 0}, 0.0}}));
  for (const std::string_view line : {"cloth", "cloth,", "cloth,x", "cloth,-1", "cloth,inf",
                                      "cloth,nan", "cloth,1,1", "\"cloth,1", ""}) {
    const std::string text = "the ball,1\n" + std::string(line) + "\ncloth,1\n";
    EXPECT_TRUE(folder.error_of([&] { (void)read_radii(folder.file("r.csv", text), groups); })
                    .starts_with("r.csv:2: expected GROUP,RADIUS, the last a number >= 0, found "))
        << line;
  }
  EXPECT_EQ(tests::message_of<std::invalid_argument>(
                [&] { (void)read_radii(folder.file("r.csv", "ball,1\n"), groups); }),
            "no group \"ball\"; there are: \"cloth\", \"the ball\", \"a,b\"");
}

}  // namespace
}  // namespace touchstone::verify::mesh::groups_test

#include "verify/mesh/obj.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/mesh_files.hpp"
#include "tests/support/messages.hpp"
#include "verify/mesh/groups.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh::obj_test {
namespace {

using fast::Edge;
using fast::Face;
using tests::coordinates;
using tests::MeshFolder;

const std::string four_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ReadObj, ReadsVerticesFacesLinesAndPoints) {
  const MeshFolder folder;
  const Mesh mesh = folder.mesh("a.obj",
                                "# a comment\nmtllib x.mtl\no thing\n"
                                "v 0.1 -2e-3 +3\r\n\tv 4 5 6 1.0 # weight\nv 7 8 9 0.5 0.5 0.5\n\n"
                                "vn 0 0 1\nvt 0 0\nv 1 1 1\ns off\n"
                                "f 1 2 3\nf 4/1 3/1 2/1\nf 1//1 2//1 4//1\nf 1/1/1 3/1/1 4/1/1\n"
                                "l 1 2 4\np 4 2\np -1\n");
  EXPECT_EQ(coordinates(mesh), (std::vector<double>{0.1, -2e-3, 3, 4, 5, 6, 7, 8, 9, 1, 1, 1}));
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{0, 1, 2}, {3, 2, 1}, {0, 1, 3}, {0, 2, 3}}));
  EXPECT_EQ(mesh.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}}));
  EXPECT_EQ(mesh.points, (std::vector<std::int32_t>{1, 3}));
}

TEST(ReadObj, ReadsPolygonsAsFansAndSaysSo) {
  const MeshFolder folder;
  const Mesh mesh =
      folder.mesh("a.obj", four_vertices +
                               "v 1 1 1 1 0 0\ng a\nf 2 3 5 4\nf 1 2 3\n"
                               "g b\nfo 1/1/1 2/2/1 3/3/1 4/4/1 5/5/1\nvt 0 0\nvt 0 1\n");
  EXPECT_EQ(mesh.faces,
            (std::vector<Face>{{1, 2, 4}, {1, 4, 3}, {0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(mesh.note,
            "polygons read as fans of triangles: 2; passed over: colours of vertices 1, vt 2");
  // The place of a fan is that of its statement.
  EXPECT_TRUE(mesh.groups.error.ends_with("a.obj:10: vertex 1 is in two groups, \"a\" and \"b\""))
      << mesh.groups.error;
  EXPECT_EQ(folder.mesh("a.obj", four_vertices + "f 1 2 3\n").note, "");
}

TEST(ReadObj, CountsNegativeCornersBackwardsAndOthersAlsoForwards) {
  const MeshFolder folder;
  EXPECT_EQ(folder.mesh("a.obj", "f 1 2 4\n" + four_vertices).faces,
            (std::vector<Face>{{0, 1, 3}}));
  const Mesh mesh = folder.mesh("a.obj", four_vertices + "f -1 -2 -4\nv 9 9 9\nf -1/-1 1 2");
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{3, 2, 0}, {4, 0, 1}}));
}

TEST(ReadObj, AMeshMustHaveAVertex) {
  const MeshFolder folder;
  const std::string error =
      "a.obj: no vertex (a line \"v x y z\"): an empty mesh, or not an OBJ file";
  for (const std::string text : {"", "# nothing\n", "o thing\nvn 0 0 1\n", "f 1 2 3\n"}) {
    EXPECT_EQ(folder.error("a.obj", text), error) << text;
  }
}

TEST(ReadObj, ReadsTheGroupsOfVertices) {
  const MeshFolder folder;
  const Groups groups = folder
                            .mesh("a.obj", "v 9 9 9\no cloth \n" + four_vertices +
                                               "f 2 3 4\ng the ball\nv 5 5 5\nv 6 6 6\np 5\nl 6 7\n"
                                               "o cloth\nv 7 7 7\n")
                            .groups;
  EXPECT_EQ(groups.names, (std::vector<std::string>{"", "cloth", "the ball"}));
  EXPECT_EQ(groups.of_vertex, (std::vector<std::int32_t>{0, 1, 1, 1, 2, 2, 2, 1}));
  EXPECT_EQ(groups.error, "");
  EXPECT_TRUE(folder.mesh("a.obj", four_vertices).groups.of_vertex.empty());
}

TEST(ReadObj, NamesTheLineAndTheReason) {
  const MeshFolder folder;
  const auto error = [&folder](const std::string& line) {
    return folder.error("a.obj", four_vertices + line + "\nv 1 1 1\n");
  };
  EXPECT_EQ(error("v 1 2"), "a.obj:5: a vertex must have three coordinates");
  EXPECT_EQ(error("v 1 2 1e999"), "a.obj:5: \"1e999\" is no number, or none that a double holds");
  EXPECT_EQ(error("v 1 nan 3"), "a.obj:5: a coordinate must be finite");
  EXPECT_EQ(error("v 1 -inf 3"), "a.obj:5: a coordinate must be finite");
  EXPECT_EQ(error("v 1 2 3 x"), "a.obj:5: \"x\" is no number, or none that a double holds");
  EXPECT_EQ(error("v -1.#IND 0 0"),
            "a.obj:5: \"-1.#IND\" is no number, or none that a double holds");
  EXPECT_EQ(error("v 0 4 0 0.5"),
            "a.obj:5: a weight other than 1; only straight edges and flat faces are read");
  EXPECT_EQ(error("v 0 4 0 1 2"),
            "a.obj:5: three coordinates and 2 more numbers; only a weight or three of a colour may "
            "follow");
  EXPECT_EQ(error("f"), "a.obj:5: corners: 0; a face must have 3 or more");
  EXPECT_EQ(error("p"), "a.obj:5: corners: 0; a point must have 1 or more");
  EXPECT_EQ(error("f 1 2 3//4/"), "a.obj:5: \"3//4/\" is no corner");
  EXPECT_EQ(error("f 1 2 6"), "a.obj:5: corner 6, but there are 5 vertices");
  EXPECT_EQ(error("f 1 2 2147483647"), "a.obj:5: corner 2147483647, but there are 5 vertices");
  EXPECT_EQ(error("f 1 2 2147483648"), "a.obj:5: \"2147483648\" is no corner");
  EXPECT_EQ(error("f 1 2 x/1"), "a.obj:5: \"x/1\" is no corner");
  EXPECT_EQ(error("f 1 2 /1"), "a.obj:5: \"/1\" is no corner");
  EXPECT_EQ(error("f 1 2 1.5"), "a.obj:5: \"1.5\" is no corner");
  EXPECT_EQ(error("f 0 1 2"),
            "a.obj:5: corner \"0\", but there are 4 vertices before it, counted from 1");
  EXPECT_EQ(error("f 1 2 -5"),
            "a.obj:5: corner \"-5\", but there are 4 vertices before it, counted from 1");
  EXPECT_EQ(error("f 1 2 -2147483648"),
            "a.obj:5: corner \"-2147483648\", but there are 4 vertices before it, counted from 1");
  EXPECT_EQ(error("f 1 2 3 9"), "a.obj:5: corner 9, but there are 5 vertices");
  EXPECT_EQ(error("l 1"), "a.obj:5: corners: 1; a line must have 2 or more");
  EXPECT_EQ(error("l 1 2 9"), "a.obj:5: corner 9, but there are 5 vertices");
}

// ---- Meshes and groups of any file ----------------------------------------------------------------

TEST(MakeMesh, JoinsTheEdgesOfFacesAndThoseNamed) {
  const std::vector<std::array<double, 3>> places{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
  const std::vector<Edge> named{{3, 0}, {0, 1}, {2, 2}, {0, 3}};
  const Mesh mesh = make_mesh(places, {{2, 1, 0}}, named);
  ASSERT_EQ(mesh.vertices.rows(), 4);
  EXPECT_EQ(mesh.vertices(2, 1), 7);
  EXPECT_EQ(mesh.vertices(3, 2), 11);
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{2, 1, 0}}));
  EXPECT_EQ(mesh.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {0, 3}}));
  EXPECT_EQ(mesh.points, (std::vector<std::int32_t>{2})) << "an edge from a vertex to itself";
}

TEST(MakeMesh, HasEachPointOnce) {
  const std::vector<std::array<double, 3>> places(4);
  const std::vector<Point> points{{3}, {0}, {3}};
  EXPECT_EQ(make_mesh(places, {}, std::vector<Edge>{{1, 1}, {0, 0}}, points).points,
            (std::vector<std::int32_t>{0, 1, 3}));
}

TEST(ReadMesh, GoesByTheExtensionInEitherCase) {
  const MeshFolder folder;
  EXPECT_EQ(folder.mesh("a.obj", "v 1 2 3\n").vertices.rows(), 1);
  EXPECT_EQ(folder.mesh("b.OBJ", "v 1 2 3\n").vertices.rows(), 1);
  EXPECT_EQ(folder.error("c.PLY", "v 1 2 3\n"), "c.PLY:1: not a PLY file");
  EXPECT_EQ(folder.error("d.stl", ""), "d.stl: unknown format: only .ply and .obj are meshes");
  EXPECT_EQ(folder.error("e", ""), "e: unknown format: only .ply and .obj are meshes");
}

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
}  // namespace touchstone::verify::mesh::obj_test

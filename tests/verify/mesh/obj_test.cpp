#include "verify/mesh/obj.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/mesh_files.hpp"

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

}  // namespace
}  // namespace touchstone::verify::mesh::obj_test

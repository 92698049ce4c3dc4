#include "verify/mesh/mesh_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tests/support/mesh_files.hpp"

namespace touchstone::verify::mesh::mesh_file_test {
namespace {

using fast::Edge;
using fast::Face;
using tests::MeshFolder;

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

}  // namespace
}  // namespace touchstone::verify::mesh::mesh_file_test

#include "verify/mesh/moving_mesh.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Core>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "touchstone/broad_phase.hpp"
#include "verify/io/dataset_error.hpp"

namespace touchstone::verify::mesh::moving_mesh_test {
namespace {

namespace fs = std::filesystem;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A triangle at rest and another that falls through it, far from a third.
MovingMesh three_triangles() {
  Points start(9, 3), end(9, 3);
  start << 0, 0, 0, 4, 0, 0, 0, 4, 0,  //
      1, 1, 1, 2, 1, 1, 1, 2, 1,       //
      90, 0, 0, 91, 0, 0, 90, 1, 0;
  end = start;
  end.block(3, 2, 3, 1).setConstant(-1.0);
  std::vector<fast::Face> faces{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  auto edges = fast::edges_of(faces);
  return {.name = "three",
          .vertices = fast::MovingVertices(start, end),
          .faces = std::move(faces),
          .edges = std::move(edges)};
}

TEST(MovingMesh, CandidatesBecomeTheirQueries) {
  const MovingMesh mesh = three_triangles();
  const auto pairs = find_candidates(mesh, Kind::vertex_face, 1);
  ASSERT_EQ(pairs.size(), 3U) << "the vertices that fall, and the triangle at rest";
  const fast::Candidates candidates = candidates_of(mesh, Kind::vertex_face, pairs);
  EXPECT_EQ(candidates.kind, Kind::vertex_face);
  EXPECT_EQ(candidates.faces.data(), mesh.faces.data());
  EXPECT_EQ(candidates.edges.data(), mesh.edges.data());
  const auto queries = queries_of(mesh, candidates);
  ASSERT_EQ(queries.size(), 3U);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(pairs[i][1], 0);
    const fast::MovingVertex& vertex = mesh.vertices[static_cast<std::size_t>(pairs[i][0])];
    EXPECT_EQ(queries[i].at(0, 0, 0), vertex.start[0]);
    EXPECT_EQ(queries[i].at(0, 0, 2), 1.0);
    EXPECT_EQ(queries[i].at(1, 0, 2), -1.0);
    EXPECT_EQ(queries[i].at(0, 2, 0), 4.0);
    EXPECT_EQ(queries[i].at(1, 3, 1), 4.0);
  }
}

TEST(MovingMesh, ASeparationAddsWhatComesThatNear) {
  const MovingMesh mesh = three_triangles();
  // The third triangle is 86 away along x.
  EXPECT_EQ(find_candidates(mesh, Kind::vertex_face, 1, {.distance = 85.0}).size(),
            find_candidates(mesh, Kind::vertex_face, 1).size() + 3)
      << "the falling triangle gets the vertices at rest";
  EXPECT_GT(find_candidates(mesh, Kind::vertex_face, 1, {.distance = 86.0}).size(),
            find_candidates(mesh, Kind::vertex_face, 1, {.distance = 85.0}).size());
}

TEST(MovingMesh, CandidatesOfEdgesAreOfItsEdges) {
  const MovingMesh mesh = three_triangles();
  const auto pairs = find_candidates(mesh, Kind::edge_edge);
  EXPECT_FALSE(pairs.empty());
  const auto queries = queries_of(mesh, candidates_of(mesh, Kind::edge_edge, pairs));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const fast::Edge& first = mesh.edges[static_cast<std::size_t>(pairs[i][0])];
    const fast::MovingVertex& vertex = mesh.vertices[static_cast<std::size_t>(first[1])];
    EXPECT_EQ(queries[i].at(1, 1, 2), vertex.end[2]);
  }
}

class Step : public ::testing::Test {
 public:
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  Step(Step&&) = delete;
  Step& operator=(Step&&) = delete;

 protected:
  Step()
      : folder_(fs::path(::testing::TempDir()) /
                (std::string("touchstone_step_") +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
                 std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Step() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

 private:
  fs::path folder_;
};

constexpr const char* triangle = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";

TEST_F(Step, IsReadFromTwoFiles) {
  const fs::path before = write("a0.obj", triangle);
  const fs::path after = write("a1.obj", "v 0 0 1\nv 4 0 2\nv 0 4 3\nf 1 2 3\n");
  const MovingMesh mesh = read_step(before, after);
  EXPECT_EQ(mesh.name, "a0-a1");
  ASSERT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.vertices[1].start, (std::array<double, 4>{4, 0, 0, 0}));
  EXPECT_EQ(mesh.vertices[1].end, (std::array<double, 4>{4, 0, 2, 0}));
  EXPECT_EQ(mesh.faces, (std::vector<fast::Face>{{0, 1, 2}}));
  EXPECT_EQ(mesh.edges.size(), 3U);
}

TEST_F(Step, RefusesAMeshWithoutCandidates) {
  for (const std::string text : {"v 0 0 0\n", "v 0 0 0\np 1\n"}) {
    const fs::path frame = write("a.obj", text);
    EXPECT_THROW(static_cast<void>(read_step(frame, frame)), io::DatasetError) << text;
  }
}

TEST_F(Step, RefusesTwoDifferentMeshes) {
  const fs::path before = write("a0.obj", triangle);
  const std::string more = std::string(triangle) + "v 1 1 1\n";
  const std::string turned = "v 0 0 1\nv 4 0 2\nv 0 4 3\nf 2 1 3\n";
  for (const std::string& text : {more, turned}) {
    const fs::path after = write("a1.obj", text);
    try {
      static_cast<void>(read_step(before, after));
      FAIL() << text;
    } catch (const io::DatasetError& error) {
      EXPECT_EQ(error.path(), after);
      EXPECT_EQ(error.reason(), "is not the same mesh as " + before.string());
    }
  }
}

TEST_F(Step, RefusesAFileThatIsNotThere) {
  const fs::path before = write("a0.obj", triangle);
  EXPECT_THROW(static_cast<void>(read_step(before, before.parent_path() / "missing.obj")),
               io::DatasetError);
}

}  // namespace
}  // namespace touchstone::verify::mesh::moving_mesh_test

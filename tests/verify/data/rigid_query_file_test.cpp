#include "verify/data/rigid_query_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::rigid_query_file_test {
namespace {

using nlohmann::json;

class RigidQueryFile : public tests::FolderTest {
 protected:
  static json pose(double x) { return {{"position", {x, 2, 3}}, {"rotation", {0.25, -x, 0}}}; }
  static json vertex_face() {
    return {{"type", "fv"},
            {"vertex", {{"pose_t0", pose(1)}, {"pose_t1", pose(4)}, {"vertex", {1, 0, 0}}}},
            {"face",
             {{"pose_t0", pose(5)},
              {"pose_t1", pose(6)},
              {"vertex0", {0, 1, 0}},
              {"vertex1", {0, 0, 1}},
              {"vertex2", {-1, 0, 0.5}}}}};
  }

  [[nodiscard]] KindOfRigidQuery read(const std::string& text) const {
    std::ofstream(path("query.json"), std::ios::binary) << text;
    return read_rigid_query(path("query.json"));
  }
  /// True if the error of reading it says so.
  [[nodiscard]] bool is_at_fault(const std::string& text, const std::string& says) const {
    const std::string error = test::error_of(folder(), [&] { (void)read(text); });
    return error.starts_with("query.json") && error.find(says) != std::string::npos;
  }
};

TEST_F(RigidQueryFile, IsReadAsItIs) {
  const KindOfRigidQuery face = read(vertex_face().dump());
  EXPECT_EQ(face.kind, Kind::vertex_face);
  EXPECT_EQ(face.query.bodies[0].end.position[0], 4.0);
  EXPECT_EQ(face.query.bodies[1].start.rotation[1], -5.0);
  EXPECT_EQ(face.query.points[0], (std::array{1.0, 0.0, 0.0}));
  EXPECT_EQ(face.query.points[3], (std::array{-1.0, 0.0, 0.5}));
  json edges = vertex_face();
  edges["type"] = "ee";
  edges["edge0"] = edges["face"];
  edges["edge1"] = edges["face"];
  edges["edge1"]["vertex1"] = {7, 8, 9};
  const KindOfRigidQuery edge = read(edges.dump());
  EXPECT_EQ(edge.kind, Kind::edge_edge);
  EXPECT_EQ(edge.query.points[1], (std::array{0.0, 0.0, 1.0}));
  EXPECT_EQ(edge.query.points[3], (std::array{7.0, 8.0, 9.0}));
}

TEST_F(RigidQueryFile, NamesWhatIsWrong) {
  EXPECT_TRUE(is_at_fault("{", ""));
  EXPECT_TRUE(is_at_fault("[]", "the query has no member type"));
  const std::vector<std::tuple<const char*, json, const char*>> changes{
      {"/type", "vv", "type must be"},
      {"/vertex/pose_t1/rotation", {1, 2}, "vertex.pose_t1.rotation must be"},
      {"/face/vertex2", {1, "2", 3}, "face.vertex2 must be"},
      {"/face", 3, "face has no member pose_t0"}};
  for (const auto& [member, value, says] : changes) {
    json query = vertex_face();
    query[json::json_pointer(member)] = value;
    EXPECT_TRUE(is_at_fault(query.dump(), says)) << says;
  }
}

}  // namespace
}  // namespace touchstone::verify::data::rigid_query_file_test

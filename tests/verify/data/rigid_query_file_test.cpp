#include "verify/data/rigid_query_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/folder_test.hpp"
#include "verify/io/dataset_error.hpp"

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
  [[nodiscard]] std::string fault(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const io::DatasetError& error) {
      return error.what();
    }
    return "";
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
  EXPECT_NE(fault("{").find("query.json"), std::string::npos);
  EXPECT_NE(fault("[]").find("the query has no member type"), std::string::npos);
  const auto changed = [&](const char* pointer, const json& value) {
    json query = vertex_face();
    query[json::json_pointer(pointer)] = value;
    return fault(query.dump());
  };
  EXPECT_NE(changed("/type", "vv").find("type must be"), std::string::npos);
  EXPECT_NE(changed("/vertex/pose_t1/rotation", {1, 2}).find("vertex.pose_t1.rotation must be"),
            std::string::npos);
  EXPECT_NE(changed("/face/vertex2", {1, "2", 3}).find("face.vertex2 must be"), std::string::npos);
  EXPECT_NE(changed("/face", 3).find("face has no member pose_t0"), std::string::npos);
}

}  // namespace
}  // namespace touchstone::verify::data::rigid_query_file_test

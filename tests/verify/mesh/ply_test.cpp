#include "verify/mesh/ply.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/mesh_files.hpp"

namespace touchstone::verify::mesh::ply_test {
namespace {

using fast::Edge;
using fast::Face;
using tests::coordinates;
using tests::MeshFolder;

/// Bytes of numbers, one after the other.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}

  template <class Number>
  Bytes& add(Number number) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if (big_endian_) std::ranges::reverse(bytes);
    text_.append(bytes.data(), bytes.size());
    return *this;
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

std::string format(bool big_endian) {
  return big_endian ? "ply\nformat binary_big_endian 1.0\n"
                    : "ply\nformat binary_little_endian 1.0\n";
}

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string xyz = "property double x\nproperty double y\nproperty double z\n";
const std::string triangle = "property list uchar int vertex_indices\n";

/// A header in text with four vertices in lines 10 to 13, and this number of faces.
std::string four_vertices(int faces) {
  return ascii + "element vertex 4\n" + xyz + "element face " + std::to_string(faces) + "\n" +
         triangle + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
}

TEST(ReadPly, ReadsText) {
  const MeshFolder folder;
  const Mesh mesh = folder.mesh(
      "a.ply", "ply\r\ncomment before\nformat ascii 1.0\nobj_info any\nelement vertex 4\n" + xyz +
                   "element face 2\n" + triangle +
                   "end_header\n0.1 -2e-3 +3\n4 5 6\r\n\n 7 8\t9 \n1 1 1\n3 0 1 2\n3 3 2 1\n\n");
  EXPECT_EQ(coordinates(mesh), (std::vector<double>{0.1, -2e-3, 3, 4, 5, 6, 7, 8, 9, 1, 1, 1}));
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{0, 1, 2}, {3, 2, 1}}));
  EXPECT_EQ(mesh.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
}

TEST(ReadPly, ReadsCoordinatesOfEveryTypeUnderBothNames) {
  const MeshFolder folder;
  const auto expect_read = [&](const std::string& name, const std::string& other, auto number) {
    Bytes little(false), big(true);
    for (int i = 0; i < 9; ++i) {
      little.add(number);
      big.add(number);
    }
    const std::string row = fmt::format("{0} {0} {0}\n", number);
    const std::vector<std::pair<std::string, std::string>> encodings{
        {ascii, row + row + row}, {format(false), little.text()}, {format(true), big.text()}};
    for (const std::string& type : {name, other}) {
      for (const auto& [start, data] : encodings) {
        const Mesh mesh =
            folder.mesh("a.ply", fmt::format("{0}element vertex 3\nproperty {1} x\nproperty {1} y\n"
                                             "property {1} z\nend_header\n{2}",
                                             start, type, data));
        EXPECT_EQ(coordinates(mesh), std::vector<double>(9, static_cast<double>(number)))
            << start << type;
      }
    }
  };
  expect_read("char", "int8", std::int8_t{-128});
  expect_read("uchar", "uint8", std::uint8_t{255});
  expect_read("short", "int16", std::int16_t{-32768});
  expect_read("ushort", "uint16", std::uint16_t{65535});
  expect_read("int", "int32", std::numeric_limits<std::int32_t>::min());
  expect_read("uint", "uint32", std::numeric_limits<std::uint32_t>::max());
  expect_read("float", "float32", 0.1F);
  expect_read("float", "float32", std::numeric_limits<float>::denorm_min());
  expect_read("double", "float64", 0.1);
  expect_read("double", "float64", -5e-324);
}

TEST(ReadPly, PassesOverOtherPropertiesAndElements) {
  const MeshFolder folder;
  const std::string header =
      "element camera 1\nproperty float view\nproperty list ushort double plan\n"
      "element nothing 5\n"
      "element vertex 3\nproperty uchar red\nproperty float z\nproperty list int uchar data\n"
      "property float x\nproperty float y\nproperty list uchar int x\n"
      "element face 1\nproperty float area\nproperty list uchar float texcoord\n"
      "property list int uint vertex_index\nproperty uchar flags\n"
      "element material 1\nproperty int id\nend_header\n";
  const auto expect = [](const Mesh& mesh) {
    EXPECT_EQ(coordinates(mesh), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(mesh.faces, (std::vector<Face>{{2, 1, 0}}));
    EXPECT_EQ(mesh.note,
              "passed over: camera 1, nothing 5, material 1, vertex.red, vertex.data, vertex.x, "
              "face.area, face.texcoord, face.flags");
  };
  expect(folder.mesh("a.ply", ascii + header +
                                  "0.5 2 1 2\n9 3 0 1 2 0\n9 6 2 7 7 4 5 1 8\n9 9 1 7 7 8 0\n"
                                  "0.5 2 0.5 0.5 3 2 1 0 9\n77\n"));
  for (const bool big_endian : {false, true}) {
    Bytes bytes(big_endian);
    bytes.add(0.5F).add(std::uint16_t{2}).add(1.0).add(2.0);
    const auto vertex = [&bytes](float z, int data, float x, float y, std::uint8_t list) {
      bytes.add(std::uint8_t{9}).add(z).add(data);
      for (int i = 0; i < data; ++i) bytes.add(std::uint8_t{7});
      bytes.add(x).add(y).add(list);
      for (int i = 0; i < list; ++i) bytes.add(8);
    };
    vertex(3, 0, 1, 2, 0);
    vertex(6, 2, 4, 5, 1);
    vertex(9, 1, 7, 8, 0);
    bytes.add(0.5F).add(std::uint8_t{2}).add(0.5F).add(0.5F);
    bytes.add(3).add(2U).add(1U).add(0U).add(std::uint8_t{9}).add(77);
    expect(folder.mesh("a.ply", format(big_endian) + header + bytes.text()));
  }
}

/// Every other triangle is turned round, in each strip anew; one with a vertex twice is a joint. Of
/// a strip of two vertices nothing is left.
TEST(ReadPly, ReadsStripsOfTriangles) {
  const MeshFolder folder;
  const std::vector<int> indices{0, 1, 2, 3, -1, -1, 1, 2, -1, 3, 2, 1, 1, 0, 2};
  const std::string header =
      "element vertex 4\n" + xyz + "element face 1\n" + triangle +
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const auto expect = [](const Mesh& mesh) {
    EXPECT_EQ(mesh.faces,
              (std::vector<Face>{{3, 1, 0}, {0, 1, 2}, {2, 1, 3}, {3, 2, 1}, {0, 1, 2}}));
    EXPECT_EQ(mesh.note, "triangles read from strips: 4");
  };
  expect(folder.mesh("a.ply", ascii + header + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 3 1 0\n" +
                                  fmt::format("{} {}\n", indices.size(), fmt::join(indices, " "))));
  Bytes bytes(true);
  for (int i = 0; i < 12; ++i) bytes.add(static_cast<double>(i));
  bytes.add(std::uint8_t{3}).add(3).add(1).add(0).add(static_cast<int>(indices.size()));
  for (const int index : indices) bytes.add(index);
  expect(folder.mesh("a.ply", format(true) + header + bytes.text()));
}

TEST(ReadPly, ReadsMoreThanItsBufferHolds) {
  const MeshFolder folder;
  Bytes bytes(false);
  for (int i = 0; i < 30'000; ++i) bytes.add(static_cast<double>(i));
  const Mesh mesh = folder.mesh(
      "a.ply", format(false) + "element vertex 10000\n" + xyz + "end_header\n" + bytes.text());
  ASSERT_EQ(mesh.vertices.size(), 30'000);
  for (Eigen::Index i = 0; i < 30'000; ++i) EXPECT_EQ(mesh.vertices.data()[i], i);
}

TEST(ReadPly, EveryTruncationIsAnError) {
  const MeshFolder folder;
  Bytes bytes(false);
  for (int i = 0; i < 9; ++i) bytes.add(1.0);
  bytes.add(std::uint8_t{3}).add(0).add(1).add(2);
  const std::string binary = format(false) + "element vertex 3\n" + xyz + "element face 1\n" +
                             triangle + "end_header\n" + bytes.text();
  for (const std::string& whole : {binary, four_vertices(1) + "3 0 1 2"}) {
    EXPECT_EQ(folder.error("a.ply", whole), "");
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_NE(folder.error("a.ply", whole.substr(0, length)), "") << length;
    }
  }
  EXPECT_EQ(
      folder.error("a.ply", binary.substr(0, binary.size() - 1)),
      "a.ply: face 0 at byte " + std::to_string(binary.size() - 13) + ": the file ends early");
  EXPECT_EQ(folder.error("a.ply", four_vertices(2) + "3 0 1 2\n"),
            "a.ply:14: face 1: the file ends early");
}

TEST(ReadPly, HugeCountsTakeNoMoreThanTheFileHas) {
  const MeshFolder folder;
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  for (const std::string& start : {ascii, format(false)}) {
    for (const std::string& elements :
         {"element vertex 2147483647\n" + xyz,
          "element other 18446744073709551615\nproperty list uchar int data\nelement vertex 0\n" +
              xyz,
          "element vertex 0\n" + xyz + "element face 2147483647\n" + triangle}) {
      EXPECT_TRUE(folder.error("a.ply", start + elements + "end_header\n")
                      .ends_with("the file ends early"));
    }
  }
  const std::string header = format(false) + "element other 1\nproperty list uint double d\n" +
                             "element vertex 0\n" + xyz + "end_header\n";
  EXPECT_EQ(folder.error("a.ply", header + std::string(4, '\xFF')),
            "a.ply: other 0 at byte " + std::to_string(header.size()) + ": the file ends early");
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000) << "KiB";
}

TEST(ReadPly, NamesWhatIsWrongWithAHeader) {
  const MeshFolder folder;
  const auto error = [&folder](const std::string& text) { return folder.error("a.ply", text); };
  EXPECT_EQ(error(""), "a.ply: not a PLY file");
  EXPECT_TRUE(error("\xFF\xFEp\0l").starts_with("a.ply:1: UTF-16 text; "));
  EXPECT_TRUE(error("ply\rformat ascii 1.0\r").starts_with("a.ply:1: a carriage return within "));
  const std::string vertex = ascii + "element vertex 1\n",
                    vertices = ascii + "element vertex 0\n" + xyz;
  const std::string lists = "face must have one list vertex_indices or vertex_index";
  const std::vector<std::pair<std::string, std::string>> headers{
      {"plyx\n", "1: not a PLY file"},
      {"ply\nformat ascii 1.0\n", "2: the header has no end"},
      {"ply\nend_header\n", "2: the header has no format"},
      {"ply\nformat text 1.0\n", "2: malformed header at \"text\""},
      {"ply\nformat ascii 2.0\n", "2: malformed header at \"2.0\""},
      {ascii + ascii.substr(4), "3: malformed header at \"ascii\""},
      {ascii + "\nend_header\n", "3: malformed header at \"\""},
      {ascii + "element vertex\n", "3: malformed header at \"\""},
      {ascii + "element vertex 18446744073709551616\n",
       "3: malformed header at \"18446744073709551616\""},
      {ascii + "element vertex 1 2\n", "3: malformed header at \"element vertex 1 2\""},
      {ascii + "property int x\n", "3: malformed header at \"property\""},
      {vertex + "property long x\n", "4: malformed header at \"long\""},
      {vertex + "property int\n", "4: a property must have a name"},
      {ascii + "end_header\n", "3: the header has no element vertex"},
      {vertex + "property int x\nproperty int z\nend_header\n", "6: vertex has no property y"},
      {vertex + xyz + "property int y\nend_header\n", "8: vertex has two properties y"},
      {vertices + vertices.substr(ascii.size()) + "end_header\n",
       "11: the header has two elements vertex"},
      {vertices + "end_header\n", "7: no vertex: the header says element vertex 0"},
      {ascii + "element vertex 2147483648\n" + xyz + "end_header\n",
       "7: more than 2^31-1 elements vertex"},
      {vertices + "element face 1\nproperty int vertex_indices\nend_header\n", "9: " + lists},
      {vertices + "element face 1\n" + triangle +
           "property list uchar int vertex_index\nend_header\n",
       "10: " + lists},
      {vertices + "element face 1\nproperty list uchar float vertex_index\nend_header\n",
       "9: face: vertex_index must be of a whole type"},
      {vertices + "element edge 1\nproperty int vertex1\nend_header\n",
       "9: edge has no property vertex2"},
      {"ply\ncomment " + std::string(2'000'000, 'x'), "2: line longer than 1 MiB"}};
  for (const auto& [text, says] : headers) EXPECT_EQ(error(text), "a.ply:" + says);
}

TEST(ReadPly, NamesWhatIsWrongInText) {
  const MeshFolder folder;
  for (const auto& [line, reason] : std::vector<std::pair<std::string, std::string>>{
           {"3 0 1 3", ""},
           {"2 0 1", "14: face 0: vertices: 2; a face must have 3 or more"},
           {"3 0 1", "14: face 0: too few values"},
           {"3 0 1 2 3", "14: face 0: too many values"},
           {"3 0 1 4", "14: face 0: vertex 4, but there are 4, counted from 0"},
           {"3 0 -1 2", "14: face 0: vertex -1, but there are 4, counted from 0"},
           {"3 0 1 1.5", "14: face 0: \"1.5\" is not a number of the property's type"},
           {"256 0 1 2", "14: face 0: \"256\" is not a number of the property's type"},
           {"3 0 1 2\n\n3 0 1 2", "16: data after the last element"}}) {
    EXPECT_EQ(folder.error("a.ply", four_vertices(1) + line + "\n"),
              reason.empty() ? "" : "a.ply:" + reason);
  }
  for (const auto& [line, reason] : std::vector<std::pair<std::string, std::string>>{
           {"0 nan 0", "a coordinate must be finite"},
           {"0 0 -inf", "a coordinate must be finite"},
           {"0 1e400 0", "\"1e400\" is not a number of the property's type"}}) {
    EXPECT_EQ(folder.error("a.ply", ascii + "element vertex 1\n" + xyz + "end_header\n" + line),
              "a.ply:8: vertex 0: " + reason);
  }
  EXPECT_EQ(folder.error("a.ply", ascii + "element vertex 1\n" + xyz +
                                      "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                                      "end_header\n0 0 0\n0 1\n"),
            "a.ply:12: edge 0: vertex 1, but there are 1, counted from 0");
}

TEST(ReadPly, NamesWhatIsWrongInBinary) {
  const MeshFolder folder;
  const std::string header = format(true) + "element vertex 1\n" + xyz +
                             "element face 1\nproperty list char short vertex_index\nend_header\n";
  const auto error = [&](const Bytes& bytes) {
    return folder.error("a.ply", header + bytes.text());
  };
  const auto at = [&header](std::size_t offset) {
    return "at byte " + std::to_string(header.size() + offset);
  };
  const auto after_vertex = [](double z) { return Bytes(true).add(0.0).add(0.0).add(z); };
  const auto face = [&](std::int8_t count, std::int16_t corner) {
    return error(after_vertex(0).add(count).add(corner).add(corner).add(corner));
  };
  EXPECT_EQ(face(3, 0), "");
  EXPECT_EQ(face(3, 1), "a.ply: face 0 " + at(24) + ": vertex 1, but there are 1, counted from 0");
  EXPECT_EQ(face(-3, 0), "a.ply: face 0 " + at(24) + ": a list of negative length");
  EXPECT_EQ(error(after_vertex(std::nan(""))),
            "a.ply: vertex 0 " + at(0) + ": a coordinate must be finite");
  const std::int16_t zero = 0;
  EXPECT_EQ(error(after_vertex(0).add(std::int8_t{3}).add(zero).add(zero).add(zero).add(zero)),
            "a.ply: byte " + std::to_string(header.size() + 31) + ": data after the last element");
}

TEST(WritePly, IsReadBackBitByBit) {
  const MeshFolder folder;
  Vertices vertices(4, 3);
  vertices << 0.1, -0.0, 1e300, 1, 2, 3, -1e-320, 5, 6, 1.0 / 3.0, 8, 9;
  const std::vector<fast::Face> faces{{0, 1, 2}};
  const std::vector<fast::Edge> edges{{2, 3}, {3, 3}};
  const std::filesystem::path path = folder.path() / "a.ply";
  write_ply(path, vertices, faces, edges);
  const Mesh mesh = read_ply(path);
  EXPECT_EQ(std::memcmp(mesh.vertices.data(), vertices.data(), 12 * sizeof(double)), 0);
  EXPECT_EQ(mesh.faces, faces);
  EXPECT_EQ(mesh.edges, (std::vector<fast::Edge>{{0, 1}, {0, 2}, {1, 2}, {2, 3}}));
  EXPECT_EQ(mesh.points, (std::vector<std::int32_t>{3}));
  write_ply(path, vertices, faces);
  EXPECT_EQ(read_ply(path).edges.size(), 3U);
}

}  // namespace
}  // namespace touchstone::verify::mesh::ply_test

#include "verify/mesh/obj.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/mesh_files.hpp"
#include "tests/support/messages.hpp"
#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/io/obj_statements.hpp"
#include "verify/mesh/frames.hpp"
#include "verify/mesh/groups.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::mesh::obj_test {
namespace {

namespace fs = std::filesystem;
using data::test::error_of;
using data::test::TemporaryFolder;
using fast::Edge;
using fast::Face;
using tests::coordinates;
using tests::MeshFolder;
using Texts = std::vector<std::string>;
using tests::archive;
using tests::array;

const std::string four_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ReadObj, ReadsVerticesFacesLinesAndPoints) {
  const MeshFolder folder;
  const Mesh mesh =
      folder.mesh("a.obj",
                  "# a comment\nmtllib x.mtl\no thing\n"
                  "v 0.1 -2e-3 +3\r\n\tv 4 5 6 1.0# weight\nv 7 8 9 0.5 0.5 0.5\n\n"
                  "vn 0 0 1\nvt 0 0\nv 1 1 1\ns off\n"
                  "f 1 2 3\nf 4/1 3/1 2/1#a face\nf 1//1 2//1 4//1\nf 1/1/1 3/1/1 4/1/1\n"
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
                                               "o cloth\nv 7 7 7\ng of no vertex\n")
                            .groups;
  EXPECT_EQ(groups.names, (std::vector<std::string>{"", "cloth", "the ball", ""}));
  EXPECT_EQ(groups.of_vertex, (std::vector<std::int32_t>{0, 1, 1, 1, 2, 2, 2, 1}));
  EXPECT_EQ(groups.error, "");
  EXPECT_TRUE(folder.mesh("a.obj", four_vertices).groups.of_vertex.empty());
}

TEST(ReadObj, NamesTheLineAndTheReason) {
  const MeshFolder folder;
  const std::string no_number = " is no number, or none that a double holds",
                    before = ", but there are 4 vertices before it, counted from 1",
                    there = ", but there are 5 vertices";
  for (const auto& [line, reason] : std::vector<std::pair<std::string, std::string>>{
           {"v 1 2", "a vertex must have three coordinates"},
           {"v 1 2 1e999", "\"1e999\"" + no_number},
           {"v 1 nan 3", "a coordinate must be finite"},
           {"v 1 -inf 3", "a coordinate must be finite"},
           {"v 1 2 3 x", "\"x\"" + no_number},
           {"v -1.#IND 0 0", "\"-1.#IND\"" + no_number},
           {"v 0 4 0 0.5", "a weight other than 1; only straight edges and flat faces are read"},
           {"v 0 4 0 1 2",
            "three coordinates and 2 more numbers; only a weight or three of a colour may follow"},
           {"f", "corners: 0; a face must have 3 or more"},
           {"p", "corners: 0; a point must have 1 or more"},
           {"f 1 2 3//4/", "\"3//4/\" is no corner"},
           {"f 1 2 6", "corner 6" + there},
           {"f 1 2 2147483647", "corner 2147483647" + there},
           {"f 1 2 2147483648", "\"2147483648\" is no corner"},
           {"f 1 2 x/1", "\"x/1\" is no corner"},
           {"f 1 2 /1", "\"/1\" is no corner"},
           {"f 1 2 1.5", "\"1.5\" is no corner"},
           {"f 0 1 2", "corner \"0\"" + before},
           {"f 1 2 -5", "corner \"-5\"" + before},
           {"f 1 2 -2147483648", "corner \"-2147483648\"" + before},
           {"f 1 2 3 9", "corner 9" + there},
           {"l 1", "corners: 1; a line must have 2 or more"},
           {"l 1 2 9", "corner 9" + there}}) {
    EXPECT_EQ(folder.error("a.obj", four_vertices + line + "\nv 1 1 1\n"), "a.obj:5: " + reason);
  }
}

// ---- Meshes and groups of any file ----------------------------------------------------------------

TEST(ReadMesh, GoesByTheExtensionInEitherCase) {
  const MeshFolder folder;
  EXPECT_EQ(folder.mesh("a.obj", "v 1 2 3\n").vertices.rows(), 1);
  EXPECT_EQ(folder.mesh("b.OBJ", "v 1 2 3\n").vertices.rows(), 1);
  EXPECT_EQ(folder.error("c.PLY", "v 1 2 3\n"), "c.PLY:1: not a PLY file");
  EXPECT_EQ(folder.error("d.stl", ""),
            "d.stl: unknown format: only .ply and .obj are meshes; " + std::string(way_of_others));
  EXPECT_EQ(folder.error("e", ""),
            "e: unknown format: only .ply and .obj are meshes; " + std::string(way_of_others));
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
  EXPECT_EQ(folder.error_of([&] {
    (void)read_radii(folder.file("r.csv", "cloth,1\nthe ball,1\n cloth,1\n"), groups);
  }),
            "r.csv:3: the group has a radius in line 1, too: leave one of them out");
  EXPECT_EQ(folder.error_of([&] {
    (void)read_separations(folder.file("s.csv", "cloth,the ball,1\nthe ball,cloth,2\n"), groups);
  }),
            "s.csv:2: the two groups have a distance in line 1, too: leave one of them out");
  EXPECT_EQ(tests::message_of<std::invalid_argument>(
                [&] { (void)read_radii(folder.file("r.csv", "ball,1\n"), groups); }),
            "no group \"ball\"; there are: \"cloth\", \"the ball\", \"a,b\"");
}

// ---- Statements ---------------------------------------------------------------------------------

/// The statements as "line keyword|words", then what was passed over.
Texts statements_of(const std::string& text) {
  const TemporaryFolder folder;
  io::ObjStatements statements(folder.file("a.obj", text));
  Texts result;
  while (const auto statement = statements.next()) {
    result.push_back(std::to_string(statement->line) + ' ' + std::string(statement->keyword) + '|' +
                     std::string(statement->words));
  }
  for (const std::string& name : statements.passed_over()) result.push_back(name);
  return result;
}

std::string error_of_statements(const std::string& text) {
  const TemporaryFolder folder;
  return error_of(folder.path(), [&] {
    io::ObjStatements statements(folder.file("a.obj", text));
    while (statements.next()) {
    }
  });
}

TEST(ObjStatements, GoOnBehindABackslash) {
  EXPECT_EQ(statements_of("f 1 \\\n2\\\r\n 3/4\\\n/5 \\\n\\\n6\nl 1 2 \\"),
            (Texts{"1 f| 1 2 3/4/5 6", "7 l| 1 2 "}));
  // A comment does not go on.
  EXPECT_EQ(statements_of("# C:\\\nv 1 2 3 # C:\\\nv 4 5 6"), (Texts{"2 v| 1 2 3 ", "3 v| 4 5 6"}));
  EXPECT_EQ(error_of_statements("f 1\\\n2 3"),
            "a.obj:2: begins within a word, or with a new one: put a blank in front of the "
            "backslash before");
  EXPECT_EQ(error_of_statements("usemtl a\\\nv 1 2 3"),
            "a.obj:2: begins with \"v\", but the line before goes on, as it ends in a backslash");
  EXPECT_EQ(error_of_statements("# " + std::string(2'000'000, 'x')),
            "a.obj:1: line longer than 1 MiB");
  const std::string half(io::LineReader::longest_line / 2, ' ');
  EXPECT_EQ(error_of_statements("f" + half + "\\\n" + half + "\\\n1"),
            "a.obj:2: line longer than 1 MiB");
}

TEST(ObjStatements, AreOfKnownKeywords) {
  for (const std::string keyword : {"V", "F", "f\u00A0", "vertices", "1,1", "t", "PK\x03"}) {
    EXPECT_TRUE(error_of_statements("v 1 2 3\n" + keyword + " 1 2 3\n").starts_with("a.obj:2: \""))
        << keyword;
  }
  EXPECT_EQ(error_of_statements("surf 0 1 0 1 1 2 3 4"),
            "a.obj:1: \"surf\" may add to the mesh and is not read: write its faces (f)");
}

// ---- Frames -------------------------------------------------------------------------------------

std::unique_ptr<Frames> open(const std::vector<fs::path>& paths) {
  return open_frames(frame_files(paths));
}

std::string triangle(int height) {
  const std::string z = " " + std::to_string(height) + "\n";
  return "v 0 0" + z + "v 1 0" + z + "v 0 1" + z + "f 1 2 3\n";
}

TEST(Frames, OfAFolderAreInTheOrderOfTheirNumbers) {
  const MeshFolder folder;
  const std::map<std::string, int> heights_of{{"10", 10}, {"9", 9},    {"100", 100},
                                              {"0.5", 2}, {"0.25", 1}, {"1e-1", 0}};
  for (const auto& [number, height] : heights_of)
    (void)folder.file("frame" + number + ".obj", triangle(height));
  (void)folder.file("notes.txt", "");
  const auto frames = open({folder.path()});
  ASSERT_EQ(frames->count(), heights_of.size());
  std::vector<double> heights;
  std::string names;
  for (std::size_t i = 0; i < frames->count(); ++i) {
    heights.push_back(frames->next()(0, 2));
    names += frames->name(i) + " ";
  }
  EXPECT_EQ(heights, (std::vector<double>{0, 1, 2, 9, 10, 100}));
  EXPECT_EQ(names, "frame1e-1.obj frame0.25.obj frame0.5.obj frame9.obj frame10.obj frame100.obj ");
  const std::vector<fs::path> files = frame_files(std::vector{folder.path()});
  EXPECT_EQ(files.size(), heights_of.size());
  EXPECT_EQ(files.front(), folder.path() / "frame1e-1.obj");
  EXPECT_EQ(frame_files(files), files);
  std::vector<fs::path> left_out;
  (void)frame_files(std::vector{folder.path()}, &left_out);
  EXPECT_EQ(left_out, (std::vector{folder.path() / "notes.txt"}));
}

TEST(Frames, OfAnotherMeshAreAnError) {
  const MeshFolder folder;
  const std::vector<std::string> others{triangle(1) + "v 1 1 1\n", triangle(1) + "f 3 2 1\n",
                                        triangle(1) + "p 1\n", "o x\n" + triangle(1)};
  for (const std::string& other : others) {
    const auto frames = open({folder.file("a.obj", triangle(0)), folder.file("b.obj", other)});
    (void)frames->next();
    const std::string error = folder.error_of([&] { (void)frames->next(); });
    EXPECT_TRUE(error.starts_with("b.obj: is not the same mesh as ")) << error;
  }
}

TEST(Frames, OfAnArchiveHaveItsElements) {
  const MeshFolder folder;
  for (const bool is_compressed : {false, true}) {
    const auto frames = open({archive(
        folder.path() / "a.npz",
        {{"V.npy", array<float>("<f4", {2, 4, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5,  //
                                                   0, 0, 1, 1, 0, 1, 0, 1, 1, 6, 6, 0.1F})},
         {"F.npy", array<std::int64_t>("<i8", {1, 3}, {0, 1, 2})},
         {"E.npy", array<std::int32_t>("<i4", {1, 2}, {3, 0})},
         {"P.npy", array<std::int32_t>("<i4", {2}, {3, 1})},
         {"speed.npy", "not read"}},
        is_compressed)});
    ASSERT_EQ(frames->count(), 2U);
    EXPECT_EQ(frames->mesh().faces, (std::vector<fast::Face>{{0, 1, 2}}));
    EXPECT_EQ(frames->mesh().edges, (std::vector<fast::Edge>{{0, 1}, {0, 2}, {1, 2}, {0, 3}}));
    EXPECT_EQ(frames->mesh().points, (std::vector<std::int32_t>{1, 3}));
    EXPECT_EQ(frames->mesh().note, "passed over: array speed");
    EXPECT_EQ(frames->next()(3, 2), 5.0);
    EXPECT_EQ(frames->next()(3, 2), static_cast<double>(0.1F));
    EXPECT_EQ(frames->name(1), "1");
  }
}

TEST(Frames, OfALargeArchiveAreReadInParts) {
  const MeshFolder folder;
  constexpr std::size_t vertices = 50'000;
  std::vector<double> numbers(2 * 3 * vertices);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  const auto frames = open(
      {archive(folder.path() / "a.npz", {{"V.npy", array<double>("<f8", {2, vertices, 3}, numbers)},
                                         {"P.npy", array<std::uint8_t>("|u1", {1}, {7})}})});
  EXPECT_EQ(frames->next()(vertices - 1, 2), 3.0 * vertices - 1);
  EXPECT_EQ(frames->next()(vertices - 1, 2), 6.0 * vertices - 1);
}

TEST(Frames, SayWhatIsWrongWithAnArchive) {
  const MeshFolder folder;
  const auto corners = [](int last) { return array<std::int32_t>("<i4", {1, 3}, {0, 0, last}); };
  const std::pair<const std::string, std::string> square{
      "V.npy", array<double>("<f8", {1, 1, 3}, {0, 0, 0})};
  for (const auto& [members, error] :
       std::vector<std::pair<std::map<std::string, std::string>, std::string>>{
           {{{"x.npy", square.second}}, "no array V of positions, of shape (T, n, 3)"},
           {{{"V.npy", array<double>("<f8", {1, 3}, {0, 0, 0})}},
            "V: shape (1, 3), expected (T, n, 3)"},
           {{{"V.npy", array<double>("<f8", {0, 1, 3}, {})}}, "V: no frame, or no vertex"},
           {{{"V.npy", array<std::int32_t>("<i4", {1, 1, 3}, {0, 0, 0})}},
            "V: dtype \"<i4\", expected <f4 or <f8"},
           {{{"V.npy", array<double>("<f8", {1, 1, 3}, {0, 0, HUGE_VAL})}},
            "V: frame 0: a coordinate must be finite"},
           {{square, {"F.npy", corners(1)}}, "F: row 0: vertex 1, but there are 1, counted from 0"},
           {{square, {"F.npy", corners(-1)}},
            "F: row 0: vertex -1, but there are 1, counted from 0"},
           {{square, {"F.npy", array<double>("<f8", {1, 3}, {0, 0, 0})}},
            "F: dtype \"<f8\", expected |i1 or |u1 or <i2 or <u2 or <i4 or <u4 or <i8 or <u8"},
           {{square, {"E.npy", corners(0)}}, "E: shape (1, 3), expected (k, 2)"}}) {
    EXPECT_EQ(folder.error_of([&] { (void)open({archive(folder.path() / "a.npz", members)}); }),
              "a.npz: " + error);
  }
  EXPECT_EQ(folder.error_of([&] { (void)open({folder.file("b.npz", "PK nothing")}); }),
            "b.npz: cannot open: Not a zip archive");
}

TEST(Frames, ThatDoNotGoTogetherAreAnError) {
  const MeshFolder folder;
  const fs::path file = folder.file("a.obj", triangle(0));
  EXPECT_EQ(folder.error_of([&] {
    (void)open({file, folder.path() / "b.npz"});
  }),
            "b.npz: pass either one archive, one folder, or a list of files");
  fs::create_directory(folder.path() / "empty");
  EXPECT_EQ(folder.error_of([&] { (void)open({folder.path() / "empty"}); }),
            "empty: no .ply or .obj file in this folder; " + std::string(way_of_others));
}

}  // namespace
}  // namespace touchstone::verify::mesh::obj_test

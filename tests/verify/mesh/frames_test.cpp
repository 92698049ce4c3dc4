#include "verify/mesh/frames.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/support/mesh_files.hpp"
#include "tests/support/npz_files.hpp"

namespace touchstone::verify::mesh::frames_test {
namespace {

namespace fs = std::filesystem;
using tests::archive;
using tests::array;
using tests::MeshFolder;

std::unique_ptr<Frames> open(const std::vector<fs::path>& paths) {
  return open_frames(frame_files(paths));
}

std::string triangle(int height) {
  const std::string z = " " + std::to_string(height) + "\n";
  return "v 0 0" + z + "v 1 0" + z + "v 0 1" + z + "f 1 2 3\n";
}

TEST(Frames, OfAFolderAreInTheOrderOfTheirNumbers) {
  const MeshFolder folder;
  for (const int i : {10, 9, 100, 1})
    (void)folder.file("frame" + std::to_string(i) + ".obj", triangle(i));
  (void)folder.file("notes.txt", "");
  const auto frames = open({folder.path()});
  ASSERT_EQ(frames->count(), 4U);
  std::vector<double> heights;
  std::string names;
  for (std::size_t i = 0; i < frames->count(); ++i) {
    heights.push_back(frames->next()(0, 2));
    names += frames->name(i) + " ";
  }
  EXPECT_EQ(heights, (std::vector<double>{1, 9, 10, 100}));
  EXPECT_EQ(names, "frame1.obj frame9.obj frame10.obj frame100.obj ");
  const std::vector<fs::path> files = frame_files(std::vector{folder.path()});
  EXPECT_EQ(files.size(), 4U);
  EXPECT_EQ(files.front(), folder.path() / "frame1.obj");
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
  const std::string square = array<double>("<f8", {1, 1, 3}, {0, 0, 0});
  const auto error = [&](const std::map<std::string, std::string>& members) {
    return folder.error_of([&] { (void)open({archive(folder.path() / "a.npz", members)}); });
  };
  EXPECT_EQ(error({{"x.npy", square}}), "a.npz: no array V of positions, of shape (T, n, 3)");
  EXPECT_EQ(error({{"V.npy", array<double>("<f8", {1, 3}, {0, 0, 0})}}),
            "a.npz: V: shape (1, 3), expected (T, n, 3)");
  EXPECT_EQ(error({{"V.npy", array<double>("<f8", {0, 1, 3}, {})}}),
            "a.npz: V: no frame, or no vertex");
  EXPECT_EQ(error({{"V.npy", array<std::int32_t>("<i4", {1, 1, 3}, {0, 0, 0})}}),
            "a.npz: V: dtype \"<i4\", expected <f4 or <f8");
  EXPECT_EQ(error({{"V.npy", array<double>("<f8", {1, 1, 3},
                                           {0, 0, std::numeric_limits<double>::infinity()})}}),
            "a.npz: V: frame 0: a coordinate must be finite");
  EXPECT_EQ(error({{"V.npy", square}, {"F.npy", array<std::int32_t>("<i4", {1, 3}, {0, 0, 1})}}),
            "a.npz: F: row 0: vertex 1, but there are 1, counted from 0");
  EXPECT_EQ(error({{"V.npy", square}, {"F.npy", array<std::int32_t>("<i4", {1, 3}, {0, 0, -1})}}),
            "a.npz: F: row 0: vertex -1, but there are 1, counted from 0");
  EXPECT_TRUE(error({{"V.npy", square}, {"F.npy", array<double>("<f8", {1, 3}, {0, 0, 0})}})
                  .starts_with("a.npz: F: dtype \"<f8\", expected "));
  EXPECT_EQ(error({{"V.npy", square}, {"E.npy", array<std::int32_t>("<i4", {1, 3}, {0, 0, 0})}}),
            "a.npz: E: shape (1, 3), expected (k, 2)");
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
            "empty: no .ply or .obj file in this folder");
}

}  // namespace
}  // namespace touchstone::verify::mesh::frames_test

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/tool_test.hpp"
#include "touchstone/oracle.hpp"
#include "verify/data/npy.hpp"

// Tests of `touchstone candidates` that run the tool.

namespace touchstone::verify::cli::candidates_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using tests::Outcome;
using tests::read_file;

using Pairs = std::vector<std::array<std::int32_t, 2>>;

/// All queries of a .npy file.
std::vector<Query> npy_queries(const fs::path& path) {
  data::NpyArray array(path);
  std::vector<Query> queries(array.shape()[0]);
  for (Query& query : queries) array.take_numbers(query.coordinates);
  return queries;
}

class CandidatesCommand : public tests::ToolTest {
 protected:
  /// Runs `touchstone candidates …` to its end.
  [[nodiscard]] Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "candidates");
    return ToolTest::run(arguments);
  }

  /// The pairs of a file, in ascending order.
  [[nodiscard]] Pairs pairs(const std::string& name) const {
    const std::string bytes = read_file(path(name));
    static constexpr std::size_t header = 128;
    EXPECT_TRUE(bytes.size() >= header && bytes.size() % 8 == 0) << name;
    Pairs result((bytes.size() - header) / 8);
    // memcpy needs addresses even for no bytes.
    if (!result.empty()) std::memcpy(result.data(), bytes.data() + header, bytes.size() - header);
    EXPECT_TRUE(contains(bytes.substr(0, header), "'<i4', 'fortran_order': False, 'shape': (" +
                                                      std::to_string(result.size()) + ", 2)"));
    return result;
  }

  /// The number of files in the folder whose names begin with this text.
  [[nodiscard]] std::size_t files(const std::string& beginning) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(fs::directory_iterator(folder()), [&](const auto& entry) {
          return entry.path().filename().string().starts_with(beginning);
        }));
  }
};

/// A resting triangle in the plane z=0, and another that falls through it from height 1 to `z`.
std::string falling_triangle(const std::string& z) {
  return "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 " + z + "\nv 2 1 " + z + "\nv 1 2 " + z +
         "\nf 1 2 3\nf 4 5 6\n";
}

TEST_F(CandidatesCommand, SaysHowManyCandidatesAreTooMany) {
  const std::string before = write("0.obj", falling_triangle("1"));
  const std::string after = write("1.obj", falling_triangle("-1"));
  const Outcome refused = run({before, after, "--out", path("step"), "--max-candidates", "2"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "0-1: 3 vertex-face candidates, more than the 2 "))
      << refused.err;
  EXPECT_TRUE(contains(refused.err, "--max-candidates")) << refused.err;
  EXPECT_EQ(files("step"), 0U);
  EXPECT_EQ(run({before, after, "--out", path("step"), "--max-candidates", "3"}).status, 0);
}

TEST_F(CandidatesCommand, WritesQueriesThatTheirPairsName) {
  const auto outcome =
      run({write("0.obj", falling_triangle("1")), write("1.obj", falling_triangle("-1")), "--out",
           path("step"), "--json", path("summary.json")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  // The vertices of the small triangle meet the large one; the boxes of its edges overlap those of
  // the other's edges.
  EXPECT_EQ(pairs("step_vf_pairs.npy"), (Pairs{{3, 0}, {4, 0}, {5, 0}}));
  EXPECT_EQ(pairs("step_edges.npy"), (Pairs{{0, 1}, {0, 2}, {1, 2}, {3, 4}, {3, 5}, {4, 5}}));
  EXPECT_EQ(pairs("step_ee_pairs.npy"), (Pairs{{2, 3}, {2, 4}, {2, 5}}));
  const std::vector<Query> vertex_face = npy_queries(path("step_vf.npy"));
  const std::vector<Query> edge_edge = npy_queries(path("step_ee.npy"));
  ASSERT_EQ(vertex_face.size(), 3U);
  ASSERT_EQ(edge_edge.size(), 3U);
  EXPECT_EQ(vertex_face[1],
            (Query{{2, 1, 1, 0, 0, 0, 4, 0, 0, 0, 4, 0, 2, 1, -1, 0, 0, 0, 4, 0, 0, 0, 4, 0}}));
  EXPECT_EQ(edge_edge[2],
            (Query{{4, 0, 0, 0, 4, 0, 2, 1, 1, 1, 2, 1, 4, 0, 0, 0, 4, 0, 2, 1, -1, 1, 2, -1}}));
  for (const Query& query : vertex_face) {
    EXPECT_TRUE(exact::decide(Kind::vertex_face, query).collides());
  }
  const auto summary = nlohmann::json::parse(read_file(path("summary.json")));
  EXPECT_EQ(summary["vertices"], 6);
  EXPECT_EQ(summary["edges"], 6);
  EXPECT_EQ(summary["faces"], 2);
  EXPECT_EQ(summary["candidates"]["vertex-face"]["count"], 3);
  EXPECT_EQ(summary["candidates"]["edge-edge"]["count"], 3);
  EXPECT_GE(summary["candidates"]["edge-edge"]["seconds"], 0.0);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_TRUE(contains(outcome.out, "vertex-face            3"));
  EXPECT_TRUE(contains(outcome.out, "vertices               6"));
}

TEST_F(CandidatesCommand, KnowsOfASeparation) {
  const std::string before = write("0.obj", falling_triangle("1"));
  const auto count = [&](const std::string& separation) {
    EXPECT_EQ(
        run({before, before, "--out", path("s"), "--min-separation", separation, "--threads", "1"})
            .status,
        0);
    return pairs("s_vf_pairs.npy").size();
  };
  EXPECT_EQ(count("0"), 0U);
  EXPECT_EQ(count("0.9999999"), 0U);
  // The falling vertices, and the resting one at the origin.
  EXPECT_EQ(count("1"), 4U);
}

TEST_F(CandidatesCommand, MakesTheFolder) {
  const std::string before = write("0.obj", falling_triangle("1"));
  EXPECT_EQ(run({before, before, "--out", path("new/folder/s")}).status, 0);
  EXPECT_TRUE(fs::exists(path("new/folder/s_edges.npy")));
}

TEST_F(CandidatesCommand, RefusesMeshesThatDiffer) {
  const std::string before = write("0.obj", falling_triangle("1"));
  const std::string other_faces = write("1.obj", falling_triangle("0") + "f 1 2 4\n");
  const std::string other_vertices = write("2.obj", falling_triangle("0") + "v 1 1 1\n");
  for (const std::string& after : {other_faces, other_vertices}) {
    const auto outcome = run({before, after, "--out", path("step")});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "is not the same mesh as " + before)) << outcome.err;
  }
  EXPECT_EQ(files("step"), 0U);
}

TEST_F(CandidatesCommand, NamesTheLineOfABadMesh) {
  const std::string before = write("0.obj", "v 0 0 0\nv 1 0\n");
  const auto outcome = run({before, before, "--out", path("step")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, before + ":2: a vertex must have three coordinates"))
      << outcome.err;
  EXPECT_EQ(files("step"), 0U);
}

TEST_F(CandidatesCommand, NeverOverwritesAnInput) {
  const std::string before = write("0.obj", falling_triangle("1"));
  const std::string after = write("1.obj", falling_triangle("0"));
  const auto json_is_input = run({before, after, "--out", path("s"), "--json", after});
  EXPECT_EQ(json_is_input.status, 2);
  EXPECT_TRUE(contains(json_is_input.err, after + ": named for input and output"));
  fs::rename(before, path("s_vf.npy"));
  fs::create_symlink(path("s_vf.npy"), before);
  const auto link_to_output = run({before, after, "--out", path("s")});
  EXPECT_EQ(link_to_output.status, 2);
  EXPECT_TRUE(contains(link_to_output.err, before + ": named for input and output"));
  EXPECT_EQ(read_file(path("s_vf.npy")), falling_triangle("1"));
  EXPECT_EQ(read_file(after), falling_triangle("0"));
}

TEST_F(CandidatesCommand, RefusesTwoOutputsInOneFile) {
  const std::string before = write("0.obj", falling_triangle("1"));
  const auto outcome = run({before, before, "--out", path("s"), "--json", path("s_ee.npy")});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, path("s_ee.npy") + ": named for two outputs")) << outcome.err;
}

TEST_F(CandidatesCommand, RefusesBadUsage) {
  const std::string before = write("0.obj", falling_triangle("1"));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{before, before},
        {before, "--out", path("s")},
        {before, before, "--out", ""},
        {before, before, "--out", path("s"), "--min-separation", "-1"},
        {before, before, "--out", path("s"), "--min-separation", "inf"},
        {before, before, "--out", path("s"), "--threads", "-1"},
        {before, path("missing.ply"), "--out", path("s")},
        {before, before, "--out", "/proc/none/s"}}) {
    const auto outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err, "");
  }
  EXPECT_EQ(files("s_"), 0U);
}

}  // namespace
}  // namespace touchstone::verify::cli::candidates_command_test

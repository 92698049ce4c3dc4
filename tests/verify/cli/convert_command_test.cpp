#include <gtest/gtest.h>
#include <zstd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/tool_test.hpp"

// Tests of `touchstone convert` (verify/cli/convert_command.cpp) that run the tool.

namespace touchstone::verify::cli::convert_command_test {
namespace {

namespace fs = std::filesystem;
using tests::contains;
using Json = nlohmann::json;

class ConvertCommand : public tests::ToolTest {
 protected:
  [[nodiscard]] std::string generated(const std::string& name,
                                      const std::string& family = "hourglass",
                                      std::vector<std::string> options = {}) const {
    options.insert(options.begin(),
                   {"generate", "--out", path(name), "--count", "50", "--family", family});
    EXPECT_EQ(run(options).status, 0) << read("err");
    return path(name);
  }

  /// What certify says of a dataset: queries, collisions, labels and times, and which are wrong.
  [[nodiscard]] std::string judged(const std::string& data) const {
    EXPECT_EQ(run({"certify", data, "--json", path("judged.json")}).status, 0) << read("err");
    const Json total = json("judged.json");
    std::string text;
    for (const char* key : {"queries", "collisions", "labels", "tois"}) {
      text += total.at(key).dump() + ' ';
    }
    return text;
  }
};

TEST_F(ConvertCommand, KeepsQueriesLabelsAndTimes) {
  const std::string data = generated("data");
  const auto outcome = run({"convert", data, "--out", path("store"), "--shard-size", "20",
                            "--source", "here", "--licence", "MIT"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "100 queries in 6 shards below "));
  EXPECT_EQ(judged(path("store")), judged(data));
  const Json manifest = json("store/manifest.json");
  EXPECT_EQ(manifest["source"], "here");
  EXPECT_EQ(manifest["licence"], "MIT");
  EXPECT_EQ(manifest["queries"], 100);
  std::uint64_t queries = 0;
  for (const Json& shard : manifest["shards"]) {
    EXPECT_EQ(shard["first"], queries % 50);
    queries += shard["queries"].get<std::uint64_t>();
    for (const Json& file : shard["files"]) {
      const std::string name = "store/" + file["file"].get<std::string>();
      EXPECT_EQ(read(name).size(), file["bytes"]);
      EXPECT_EQ(file["sha256"].get<std::string>().size(), 64U);
    }
  }
  EXPECT_EQ(queries, 100U);
  // The same bytes from a store, whatever the number of threads.
  ASSERT_EQ(run({"convert", path("store"), "--out", path("again"), "--threads", "1"}).status, 0);
  ASSERT_EQ(run({"convert", path("store"), "--out", path("third"), "--threads", "4"}).status, 0);
  EXPECT_EQ(read("again/manifest.json"), read("third/manifest.json"));
  EXPECT_EQ(judged(path("again")), judged(data));
}

TEST_F(ConvertCommand, ReadsCompressedCsvAsEveryCommandDoes) {
  const std::string data = generated("data");
  const std::string text = read("data/edge-edge/hourglass.csv");
  std::string compressed(ZSTD_compressBound(text.size()), '\0');
  compressed.resize(
      ZSTD_compress(compressed.data(), compressed.size(), text.data(), text.size(), 3));
  const std::string whole = write("z/edge-edge/hourglass.csv.zst", compressed);
  fs::create_directories(path("z/edge-edge/toi"));
  fs::copy_file(path("data/edge-edge/toi/hourglass_toi.csv"),
                path("z/edge-edge/toi/hourglass_toi.csv"));
  EXPECT_EQ(judged(path("z")), judged(path("data/edge-edge")));
  ASSERT_EQ(run({"convert", path("z"), "--out", path("store")}).status, 0) << read("err");
  EXPECT_EQ(judged(path("store")), judged(path("data/edge-edge")));
  // A cut stream is one error, also where the command goes on.
  const std::string cut = write("cut/x_ee.csv.zst", compressed.substr(0, compressed.size() / 2));
  for (const std::string option : {"--threads=1", "--keep-going"}) {
    const auto outcome = run({"convert", cut, "--out", path("cut_store" + option), option});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "x_ee.csv.zst: its compressed stream is cut")) << outcome.err;
  }
}

TEST_F(ConvertCommand, ReadsVertices) {
  std::string text;
  for (int i = 0; i < 16; ++i) text += "v " + std::to_string(i) + " 0.5 -1\n";
  const std::string file = write("x.obj", text);
  EXPECT_EQ(run({"convert", file, "--out", path("a")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "pass --kind"));
  EXPECT_EQ(run({"convert", file, "--kind", "edge-edge", "--out", path("b")}).status, 0);
  EXPECT_EQ(json("b/manifest.json")["queries"], 2);
}

TEST_F(ConvertCommand, KeepsTheSeparationAndMixesNone) {
  const std::string apart = generated("apart", "separation-corner", {"--min-separation", "0x1p-6"});
  const std::string touching = generated("touching");
  ASSERT_EQ(run({"convert", apart, "--out", path("store")}).status, 0) << read("err");
  EXPECT_EQ(judged(path("store")), judged(apart));
  EXPECT_EQ(read("store/separation.json"), read("apart/separation.json"));
  EXPECT_EQ(run({"convert", apart, touching, "--out", path("both")}).status, 2);
  EXPECT_FALSE(fs::exists(path("both")));
}

TEST_F(ConvertCommand, RefusesWhatIsNoNewStore) {
  const std::string data = generated("data");
  EXPECT_EQ(run({"convert", data, "--out", data}).status, 2);
  EXPECT_TRUE(contains(read("err"), "is not empty; choose another folder"));
  EXPECT_EQ(run({"convert", data, data, "--out", path("a")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "another input has the name"));
  EXPECT_EQ(run({"convert", path("none"), "--out", path("b")}).status, 2);
  write("bad_ee.csv", "1,2\n");
  EXPECT_EQ(run({"convert", path("bad_ee.csv"), "--out", path("c")}).status, 2);
  // What was written is no store.
  write("c/vertex-face/some.npy", "");
  EXPECT_EQ(run({"certify", path("c")}).status, 2);
  EXPECT_TRUE(contains(read("err"), "the manifest of its store does not name it"));
}

}  // namespace
}  // namespace touchstone::verify::cli::convert_command_test

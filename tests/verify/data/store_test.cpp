#include "verify/data/store.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::store_test {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::TemporaryFolder;

/// A store of a shard with a label file.
class Store : public ::testing::Test {
 protected:
  void manifest(const std::string& files) const {
    static_cast<void>(folder_.file(
        "manifest.json",
        R"({"format": "touchstone store 1", "shards": [{"files": [)" + files + "]}]}"));
  }

  [[nodiscard]] std::string error() const {
    return error_of(folder_.path(), [&] { (void)find_datasets(std::vector{folder_.path()}); });
  }

  TemporaryFolder folder_;
  fs::path shard_ = folder_.file("edge-edge/a.npy", "1234");
};

TEST_F(Store, HasTheFilesOfItsManifest) {
  EXPECT_TRUE(store_digests(folder_.path(), {}).empty());
  const std::string a = R"({"file": "edge-edge/a.npy", "bytes": 4, "sha256": "00"})";
  manifest(a);
  EXPECT_EQ(error(), "no DatasetError");
  const std::map<fs::path, std::string> expected{{shard_.lexically_normal(), "00"}};
  EXPECT_EQ(store_digests(folder_.path() / ".", std::vector{shard_}), expected);
  manifest(a + R"(, {"file": "edge-edge/b.npy", "bytes": 4, "sha256": "00"})");
  EXPECT_EQ(error(), "edge-edge/b.npy: missing, but the manifest of its store names it");
  manifest(R"({"file": "edge-edge/a.npy", "bytes": 5, "sha256": "00"})");
  EXPECT_EQ(error(), "edge-edge/a.npy: 4 bytes, but the manifest of its store says 5");
  manifest("");
  EXPECT_EQ(
      error(),
      "edge-edge/a.npy: the manifest of its store does not name it (a conversion that was cut "
      "short?)");
  manifest("1");
  EXPECT_TRUE(error().starts_with("manifest.json: not the manifest of a store: "));
  static_cast<void>(folder_.file("manifest.json", "{"));
  EXPECT_TRUE(error().starts_with("manifest.json:")) << error();
}

TEST_F(Store, IsNotWhatHasAnotherManifest) {
  static_cast<void>(folder_.file("manifest.json", R"({"name": "a page"})"));
  EXPECT_EQ(error(), "no DatasetError");
  static_cast<void>(folder_.file("manifest.json", "[1]"));
  EXPECT_EQ(error(), "no DatasetError");
}

}  // namespace
}  // namespace touchstone::verify::data::store_test

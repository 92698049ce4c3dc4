#include "verify/data/dataset.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/public_data.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/data/csv_dataset.hpp"
#include "verify/data/dataset_source.hpp"

namespace touchstone::verify::data::dataset_test {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::expect_numbered;
using test::joined;
using test::numbered_lines;
using test::read_all;
using test::read_survivors;
using test::Survivors;
using test::TemporaryFolder;

std::vector<fs::path> found_in(const fs::path& path) {
  return find_datasets(std::vector<fs::path>{path});
}

TEST(FindDatasets, AFolderNamedLikeACompanionIsSearchedIfItIsNamedItself) {
  const TemporaryFolder folder;
  const fs::path path = folder.file("boxes/data.csv/1vf.csv", "");
  EXPECT_EQ(found_in(folder.path() / "boxes"), std::vector<fs::path>{path});
}

TEST(FindDatasets, NamesWhatIsNotThereAndFoldersWithoutDatasets) {
  const TemporaryFolder folder;
  (void)folder.file("empty/toi/1vf_toi.csv", "");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)found_in(folder.path() / "none.csv"); }),
            "none.csv: does not exist");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)found_in(folder.path() / "empty"); }),
            "empty: no dataset (.csv, .npy) in this folder");
}

/// The files that are left out below a folder, by their paths in it.
std::vector<std::string> left_out_in(const TemporaryFolder& folder) {
  std::vector<std::string> messages;
  (void)find_datasets(std::vector<fs::path>{folder.path()}, [&](const io::DatasetError& error) {
    messages.push_back(error_of(folder.path(), [&] { throw io::DatasetError(error); }));
  });
  return messages;
}

TEST(FindDatasets, FollowsLinksToFilesAndFolders) {
  const TemporaryFolder folder, elsewhere;
  const fs::path file = folder.file("a/1vf.csv", "");
  (void)elsewhere.file("deep/er/2vf.csv", "");
  fs::create_symlink(elsewhere.path() / "deep", folder.path() / "link");
  fs::create_symlink(elsewhere.path() / "deep/er/2vf.csv", folder.path() / "z.csv");
  const fs::path linked = folder.path() / "link/er/2vf.csv", z = folder.path() / "z.csv";
  EXPECT_EQ(found_in(folder.path()), (std::vector{file, linked, z}));
  const fs::path text = elsewhere.file("x.txt", ""), toi = elsewhere.file("toi/1vf_toi.csv", "");
  EXPECT_EQ(find_datasets(std::vector{toi, folder.path(), text}),
            (std::vector{toi, file, linked, z, text}))
      << "in the given order, and named files as they are";
  EXPECT_EQ(left_out_in(folder), std::vector<std::string>{});
  EXPECT_EQ(found_in(folder.path() / "link"), std::vector{folder.path() / "link/er/2vf.csv"});
}

TEST(FindDatasets, SearchesNoFolderTwiceHoweverLinksLeadToIt) {
  const TemporaryFolder folder;
  const fs::path file = folder.file("b/1vf.csv", ""), second = folder.file("b/c/2vf.csv", "");
  fs::create_symlink(folder.path(), folder.path() / "b/c/ring");
  fs::create_symlink("b", folder.path() / "a");
  fs::create_symlink("itself", folder.path() / "itself");
  fs::create_symlink("nothing", folder.path() / "b/nowhere.csv");
  EXPECT_EQ(found_in(folder.path()), (std::vector{file, second})) << "by their plain paths";
  EXPECT_EQ(left_out_in(folder),
            (std::vector<std::string>{
                "b/nowhere.csv: left out: a link that leads to no file or folder",
                "itself: left out: a link that leads to no file or folder",
                "a: left out: leads to a folder that was searched already",
                "b/c/ring: left out: leads to a folder that was searched already"}));
}

TEST(FindDatasets, FindsDatasetsAndNamesWhatItLeavesOutButForCompanions) {
  const TemporaryFolder folder;
  std::vector<fs::path> expected;
  for (const std::string dataset :
       {"a/edge-edge/data_0_0.csv", "a/vertex-face/data_0_0.csv", "s/1vf.csv", "z.npy"}) {
    expected.push_back(folder.file(dataset, ""));
  }
  for (const std::string companion :
       {"s/toi/1vf_toi.csv", "s/1ee_toi.csv", "s/mma_bool/1vf_mma_bool.json", "s/1ee_mma_bool.json",
        "s/separation.json", "s/boxes/1vf.json", "s/frames/1.ply",
        "s/1vf.csv.touchstone.partial-1"}) {
    (void)folder.file(companion, "");
  }
  EXPECT_EQ(found_in(folder.path()), expected);
  EXPECT_EQ(left_out_in(folder), std::vector<std::string>{});
  for (const std::string name :
       {"README.md", "s/1vf.npz", "s/1vf.csv.partial-1-0", "s/boxes/1vf.csv",
        "s/frames/deep/1vf.npy", "s/mma_bool/odd.csv", "s/toi/1vf.csv"}) {
    (void)folder.file(name, "");
  }
  ASSERT_EQ(::mkfifo((folder.path() / "s/pipe.csv").c_str(), 0600), 0);
  const std::string in_companions =
      ": left out: in a folder of companion files; name the file itself to read it";
  EXPECT_EQ(found_in(folder.path()), expected);
  EXPECT_EQ(
      left_out_in(folder),
      (std::vector<std::string>{
          "README.md: left out: no dataset (.csv, .npy)",
          "s/1vf.csv.partial-1-0: left out: no dataset (.csv, .npy)",
          "s/1vf.npz: left out: no dataset (.csv, .npy)", "s/boxes/1vf.csv" + in_companions,
          "s/frames/deep/1vf.npy" + in_companions, "s/mma_bool/odd.csv" + in_companions,
          "s/pipe.csv: left out: neither a file nor a folder", "s/toi/1vf.csv" + in_companions}));
}

/// The deepest part of the path wins, then the ending of the name; letters are a kind only where
/// they are a word.
TEST(KindFromPath, IsThatOfItsDeepestWordIfThereIsOne) {
  for (const std::string path :
       {"a/edge-edge/data_0_0.csv", "vertex-face/x/edge-edge/d.csv", "my-edge-edge-queries/1vf.csv",
        "2edge-edge_queries/d.csv", "x_ee.npy", "x-ee.npy", "x ee.npy", "x.ee.npy", "ee.npy",
        "326ee.npy", "x_326ee.npy", "3d-ee.npy"}) {
    EXPECT_EQ(kind_from_path(path), ContactKind::edge_edge) << path;
  }
  for (const std::string path :
       {"a/vertex-face/data_0_0.csv", "edge-edge/my-vertex-face-set.npy", "queries/326vf.csv",
        "x_vf.csv", "vf.csv", "92vf.csv", "cloth-92vf.csv", "a_vf.csv"}) {
    EXPECT_EQ(kind_from_path(path), ContactKind::vertex_face) << path;
  }
  for (const std::string path :
       {"tree.npy", "x_tree.csv", "coffee.csv", "4fa9ee.npy", "w1ee.csv", "pdvf.csv",
        "n\u00E9ee.csv", "knowledge-edge.csv", "edge-edges/d.csv", "vertex-facet/d.csv", "x_EE.csv",
        "ee_.csv", "data.csv", "vf/data.csv", "vertex_face/data.csv", "vf1.csv"}) {
    EXPECT_EQ(error_of("", [&] { (void)kind_from_path(path); }),
              path +
                  ": the path does not say whether its queries are vertex-face or edge-edge; "
                  "pass --kind vertex-face or --kind edge-edge");
  }
  EXPECT_EQ(
      error_of("", [] { (void)kind_from_path("vertex-face/edge-edge-vertex-face.csv"); }),
      "vertex-face/edge-edge-vertex-face.csv: \"edge-edge-vertex-face.csv\" names several kinds; "
      "pass --kind");
}

TEST(OpenDataset, OpeningErrorsThrowEvenIfItKeepsGoing) {
  const TemporaryFolder folder;
  const auto opening_error = [&](const fs::path& path) {
    return error_of(folder.path(), [&] { (void)open_dataset(path, {.keep_going = true}); });
  };
  fs::create_directory(folder.path() / "folder-vf.csv");
  EXPECT_EQ(opening_error(folder.path() / "folder-vf.csv"), "folder-vf.csv: is a folder");
  EXPECT_EQ(opening_error(folder.path() / "1vf.csv"),
            "1vf.csv: cannot open: No such file or directory");
  fs::create_symlink("/proc/self/mem", folder.path() / "2vf.csv");
  EXPECT_EQ(opening_error(folder.path() / "2vf.csv"), "2vf.csv: cannot read: Input/output error");
  EXPECT_EQ(opening_error(folder.file("1vf.txt", "")),
            "1vf.txt: unknown format: only .csv, .csv.zst, .npy and .npz are datasets");
  EXPECT_EQ(opening_error(folder.file("empty_vf.csv", "")), "empty_vf.csv: no queries");
  EXPECT_EQ(opening_error(folder.file("empty_vf.npy", "")), "empty_vf.npy: not a NumPy file");
  EXPECT_TRUE(opening_error(folder.file("a.csv", joined(numbered_lines(1, true))))
                  .ends_with("pass --kind vertex-face or --kind edge-edge"));
}

/// What its labels and times are is in certify_test.cpp.
TEST(PublicData, WritingAHandcraftedFileAgainGivesTheSameBytes) {
  const fs::path folder = tests::public_data_folder();
  if (folder.empty()) GTEST_SKIP() << "no public data";
  const TemporaryFolder temporary;
  for (const fs::path& original : found_in(folder / "handcrafted")) {
    const fs::path copy = temporary.path() / "copy.csv";
    CsvWriter writer(copy);
    for (const RecordedQuery& record : read_all(*open_dataset(original))) {
      writer.write(record.query, record.collides.value());
    }
    writer.close();
    const std::string text = test::contents(original);
    EXPECT_EQ(test::contents(copy), text + (text.ends_with('\n') ? "" : "\n")) << original;
  }
}

// ---- Queries with their labels and times --------------------------------------------------------

using Messages = std::vector<std::string>;

/// Three queries with the given companions ("" for none), read with keep_going.
struct Scene {
  std::vector<std::string> lines = numbered_lines(3, false);
  std::string labels = {};
  std::string tois = {};
  TemporaryFolder folder = {};

  [[nodiscard]] std::filesystem::path make() const {
    if (!labels.empty()) (void)folder.file("s/mma_bool/7vf_mma_bool.json", labels);
    if (!tois.empty()) (void)folder.file("s/toi/7vf_toi.csv", tois);
    return folder.file("s/queries/7vf.csv", joined(lines));
  }

  /// The error and the survivors; the error must be the first message.
  [[nodiscard]] Survivors read() const {
    const auto path = make();
    const std::string error = error_of(folder.path(), [&] { (void)read_all(*open_dataset(path)); });
    Survivors kept = read_survivors(path, folder.path());
    EXPECT_EQ(kept.messages.size(), kept.skipped);
    EXPECT_EQ(error, kept.messages.empty() ? "no DatasetError" : kept.messages.front());
    for (std::string& message : kept.messages) {
      const std::string detour = "s/queries/../";
      if (message.starts_with(detour)) message = message.substr(detour.size());
    }
    return kept;
  }
};

TEST(DatasetSource, ASkippedQueryDoesNotShiftTheTruthOfTheOthers) {
  Scene scene{.labels = "[true,false,true]", .tois = "query,toi\n0,0.5\n1,0.25\n2,1\n"};
  scene.lines[8] = "bad,1,1,1,1,1";
  const Survivors kept = scene.read();
  expect_numbered(kept.records, {0, 2});
  EXPECT_EQ(kept.messages, Messages{"s/queries/7vf.csv:9:1: not a number: \"bad\""});
  EXPECT_EQ(kept.records[1].collides, std::optional(true));
  EXPECT_EQ(kept.records[1].toi, exact::Rational(1));
}

/// What has no truth is skipped; what goes on behind the queries counts once.
TEST(DatasetSource, AFaultyCompanionCostsTheQueriesWhoseTruthIsLost) {
  struct Faulty {
    std::string labels, tois;
    std::vector<std::uint64_t> kept;
    Messages messages;
  };
  const std::string json = "mma_bool/7vf_mma_bool.json: ", csv = "toi/7vf_toi.csv:";
  for (const auto& [labels, tois, kept, messages] : std::vector<Faulty>{
           {"", "query,toi\n1,half\n2,1\n", {0, 2}, {csv + "2:2: not a number: \"half\""}},
           {"", "query,toi\n0,1\n0,1\n2,1\n", {0, 2}, {csv + "3:1: query numbers do not ascend"}},
           {"[true]",
            "",
            {0},
            {json + "no label for query 1: there are only 1",
             json + "no label for query 2: there are only 1"}},
           {"[true,false,true,true,true]", "", {0, 1, 2}, {json + "5 labels, but 3 queries"}}}) {
    const Survivors found = Scene{.labels = labels, .tois = tois}.read();
    expect_numbered(found.records, kept);
    EXPECT_EQ(found.messages, messages);
  }
}

TEST(DatasetSource, TwoSourcesOfLabelsMustAgree) {
  const Survivors kept = Scene{.lines = numbered_lines(3, true), .labels = "[0,0,0]"}.read();
  expect_numbered(kept.records, {0, 2});
  ASSERT_EQ(kept.messages.size(), 1U);
  EXPECT_TRUE(kept.messages[0].starts_with("s/queries/7vf.csv:9:7: label differs from that in "));
  EXPECT_TRUE(kept.messages[0].ends_with("/mma_bool/7vf_mma_bool.json"));
  EXPECT_EQ((Scene{.lines = numbered_lines(3, true), .labels = "[0,1,0]"}.read().skipped), 0U);
}

TEST(DatasetSource, CompanionsThatCannotBeOpenedThrowEvenIfItKeepsGoing) {
  for (const Scene& scene : {Scene{.labels = "[true,"}, Scene{.tois = "toi\n"}}) {
    const auto path = scene.make();
    EXPECT_THROW((void)open_dataset(path, {.keep_going = true}), io::DatasetError);
  }
}

}  // namespace
}  // namespace touchstone::verify::data::dataset_test

#include "verify/data/dataset_source.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::dataset_source_test {
namespace {

using test::error_of;
using test::expect_numbered;
using test::joined;
using test::numbered_lines;
using test::read_all;
using test::read_survivors;
using test::Survivors;
using test::TemporaryFolder;

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

TEST(DatasetSource, JoinsQueriesWithTheirCompanions) {
  const Survivors kept =
      Scene{.labels = "[true,false,true]", .tois = "query,toi\n0,0.5\n2,1\n"}.read();
  expect_numbered(kept.records, {0, 1, 2});
  EXPECT_EQ(kept.skipped, 0U);
  EXPECT_EQ(kept.records[0].collides, std::optional(true));
  EXPECT_EQ(kept.records[1].collides, std::optional(false));
  EXPECT_EQ(kept.records[2].collides, std::optional(true));
  EXPECT_EQ(kept.records[0].toi, exact::Rational(1, 2));
  EXPECT_EQ(kept.records[1].toi, std::nullopt);
  EXPECT_EQ(kept.records[2].toi, exact::Rational(1));
}

TEST(DatasetSource, ASkippedQueryDoesNotShiftTheTruthOfTheOthers) {
  Scene scene{.labels = "[true,false,true]", .tois = "query,toi\n0,0.5\n1,0.25\n2,1\n"};
  scene.lines[8] = "bad,1,1,1,1,1";
  const Survivors kept = scene.read();
  expect_numbered(kept.records, {0, 2});
  EXPECT_EQ(kept.messages, Messages{"s/queries/7vf.csv:9:1: not a number: \"bad\""});
  EXPECT_EQ(kept.records[1].collides, std::optional(true));
  EXPECT_EQ(kept.records[1].toi, exact::Rational(1));
}

/// A bad label or time costs its query, a broken file every later one; what goes on behind the
/// queries counts once a file.
TEST(DatasetSource, AFaultyCompanionCostsTheQueriesWhoseTruthIsLost) {
  struct Faulty {
    std::string labels, tois;
    std::vector<std::uint64_t> kept;
    Messages messages;
  };
  const std::string json = "mma_bool/7vf_mma_bool.json:1:", csv = "toi/7vf_toi.csv:";
  for (const auto& [labels, tois, kept, messages] : std::vector<Faulty>{
           {"[true,null,true]", "", {0, 2}, {json + "7: not a boolean: \"null\""}},
           {"", "query,toi\n1,half\n2,1\n", {0, 2}, {csv + "2:2: not a number: \"half\""}},
           {"[true;false]", "", {0}, Messages(2, json + "6: expected ',' or ']'")},
           {"",
            "query,toi\n0,1\n0,1\n",
            {0},
            Messages(2, csv + "3:1: query numbers do not ascend")},
           {"[true]",
            "",
            {0},
            {json + "6: no label for query 1: the array has only 1",
             json + "6: no label for query 2: the array has only 1"}},
           {"[true,false,true,true,true]",
            "query,toi\n3,1\n4,1\n",
            {0, 1, 2},
            {json + "18: more labels than the 3 queries",
             csv + "2:1: toi of query 3, but there are 3 queries"}}}) {
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
  for (const Scene& scene : {Scene{.labels = "{}"}, Scene{.tois = "toi\n"}}) {
    const auto path = scene.make();
    EXPECT_THROW((void)open_dataset(path, {.keep_going = true}), io::DatasetError);
  }
}

}  // namespace
}  // namespace touchstone::verify::data::dataset_source_test

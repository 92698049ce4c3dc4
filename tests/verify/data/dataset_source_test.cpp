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

TEST(DatasetSource, ATruncatedQueryTakesItsLabelWithIt) {
  Scene scene{.labels = "[true,false,true]", .tois = "query,toi\n2,1\n"};
  scene.lines.resize(20);
  const Survivors kept = scene.read();
  expect_numbered(kept.records, {0, 1});
  ASSERT_EQ(kept.messages.size(), 1U);
  EXPECT_TRUE(
      kept.messages[0].starts_with("s/queries/7vf.csv:20: truncated query: 4 of 8 rows; if "));
}

TEST(DatasetSource, ABadLabelOrToiCostsItsQueryOnly) {
  Survivors kept = Scene{.labels = "[true,null,true]"}.read();
  expect_numbered(kept.records, {0, 2});
  EXPECT_EQ(kept.messages, Messages{"mma_bool/7vf_mma_bool.json:1:7: not a boolean: \"null\""});
  kept = Scene{.tois = "query,toi\n1,half\n2,1\n"}.read();
  expect_numbered(kept.records, {0, 2});
  EXPECT_EQ(kept.messages, Messages{"toi/7vf_toi.csv:2:2: not a number: \"half\""});
  EXPECT_EQ(kept.records[1].toi, exact::Rational(1));
}

TEST(DatasetSource, ABrokenCompanionCostsEveryLaterQuery) {
  Survivors kept = Scene{.labels = "[true;false]"}.read();
  expect_numbered(kept.records, {0});
  EXPECT_EQ(kept.messages, Messages(2, "mma_bool/7vf_mma_bool.json:1:6: expected ',' or ']'"));
  kept = Scene{.tois = "query,toi\n0,1\n0,1\n"}.read();
  expect_numbered(kept.records, {0});
  EXPECT_EQ(kept.messages, Messages(2, "toi/7vf_toi.csv:3:1: query numbers do not ascend"));
}

TEST(DatasetSource, MissingLabelsCostTheirQueries) {
  const Survivors kept = Scene{.labels = "[true]"}.read();
  expect_numbered(kept.records, {0});
  EXPECT_EQ(
      kept.messages,
      (Messages{"mma_bool/7vf_mma_bool.json:1:6: no label for query 1: the array has only 1",
                "mma_bool/7vf_mma_bool.json:1:6: no label for query 2: the array has only 1"}));
}

TEST(DatasetSource, WhatGoesOnBehindTheQueriesCountsOnceAFile) {
  const Survivors kept =
      Scene{.labels = "[true,false,true,true,true]", .tois = "query,toi\n3,1\n4,1\n"}.read();
  expect_numbered(kept.records, {0, 1, 2});
  EXPECT_EQ(kept.messages,
            (Messages{"mma_bool/7vf_mma_bool.json:1:18: more labels than the 3 queries",
                      "toi/7vf_toi.csv:2:1: toi of query 3, but there are 3 queries"}));
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

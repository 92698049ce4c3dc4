#include "verify/data/npy_dataset.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::npy_dataset_test {
namespace {

using test::error_of;
using test::expect_numbered;
using test::numbered_query;
using test::read_all;
using test::read_survivors;
using test::TemporaryFolder;

/// Writes numbered queries and then corrupts one double; NpyWriter itself would refuse it.
std::filesystem::path spoiled_file(const TemporaryFolder& folder, std::size_t query,
                                   std::size_t coordinate, double value) {
  std::filesystem::path path = folder.path() / "a_vf.npy";
  NpyWriter writer(path);
  for (std::size_t i = 0; i < 4; ++i) writer.write(numbered_query(i));
  writer.close();
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(128 + 192 * query + 8 * coordinate));
  const void* const bytes = &value;
  file.write(static_cast<const char*>(bytes), sizeof(value));
  return path;
}

TEST(NpyDataset, StreamsAllQueriesWithoutTruth) {
  const TemporaryFolder folder;
  const auto path = spoiled_file(folder, 0, 0, 0.0);
  NpyDataset source(path, {});
  EXPECT_EQ(source.kind(), Kind::vertex_face);
  EXPECT_EQ(source.name(), path.string());
  EXPECT_EQ(source.progress(), 0.0);
  ASSERT_TRUE(source.next().has_value());
  EXPECT_EQ(source.progress(), 0.25);
  const auto records = read_all(source);
  expect_numbered(records, {1, 2, 3});
  for (const auto& record : records) {
    EXPECT_FALSE(record.collides.has_value());
    EXPECT_FALSE(record.toi.has_value());
  }
  EXPECT_EQ(source.progress(), 1.0);
}

TEST(NpyDataset, NamesTheCoordinateThatIsNotFiniteAndSkipsItsQueryOnly) {
  const TemporaryFolder folder;
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t coordinate = 0; coordinate < 24; ++coordinate) {
    const double bad = std::array{std::nan(""), infinity, -infinity}.at(coordinate % 3);
    const auto path = spoiled_file(folder, 2, coordinate, bad);
    const std::string expected = "a_vf.npy: query 2, point " + std::to_string(coordinate / 3) +
                                 ", " + "xyz"[coordinate % 3] + ": not finite";
    EXPECT_EQ(error_of(folder.path(), [&] { (void)read_all(*open_dataset(path)); }), expected);
    const auto kept = read_survivors(path, folder.path());
    expect_numbered(kept.records, {0, 1, 3});
    EXPECT_EQ(kept.skipped, 1U);
    EXPECT_EQ(kept.messages, std::vector<std::string>{expected});
  }
}

TEST(NpyDataset, ThatBecomesShorterGivesWhatIsThereAndThenOneError) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a_vf.npy";
  for (const bool keep_going : {false, true}) {
    NpyWriter writer(path);
    for (std::size_t i = 0; i < 3000; ++i) writer.write(numbered_query(i));
    writer.close();
    std::vector<std::string> messages;
    NpyDataset source(path,
                      {.keep_going = keep_going, .on_skip = [&](const io::DatasetError& fault) {
                         messages.emplace_back(fault.reason());
                       }});
    std::vector<RecordedQuery> records{source.next().value()};
    std::filesystem::resize_file(path, 128 + 192 * 2000);
    const std::string error = error_of(folder.path(), [&] {
      while (auto record = source.next()) records.push_back(*record);
    });
    std::vector<std::uint64_t> there(1536);  // whole blocks
    std::iota(there.begin(), there.end(), 0);
    expect_numbered(records, there);
    const std::string reason = "the array ends early: it has become shorter while it was read";
    EXPECT_EQ(error, keep_going ? "no DatasetError" : "a_vf.npy: " + reason);
    EXPECT_EQ(messages, std::vector<std::string>(keep_going ? 1 : 0, reason));
    EXPECT_EQ(source.skipped(), keep_going ? 1U : 0U);
    EXPECT_FALSE(source.next().has_value()) << "it has ended";
  }
}

// ---- Archives ----

constexpr std::size_t size = 3 * query_points;

/// More queries than a block has: coordinate k of query i is i + k / 32, in float, too.
template <class Number>
std::vector<Number> coordinates(std::size_t count) {
  std::vector<Number> result;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < size; ++k) {
      result.push_back(static_cast<Number>(i) + static_cast<Number>(k) / 32);
    }
  }
  return result;
}

class NpzQueries : public ::testing::Test {
 protected:
  /// The archive of these members.
  [[nodiscard]] std::filesystem::path write(const std::map<std::string, std::string>& members,
                                            bool is_compressed = true) const {
    return tests::archive(folder_.path() / "a_ee.npz", members, is_compressed);
  }

  [[nodiscard]] std::string error_with(const std::map<std::string, std::string>& members) const {
    return error_of(folder_.path(), [&] {
      NpyDataset source(write(members), {});
      (void)read_all(source);
    });
  }

  TemporaryFolder folder_;
};

TEST_F(NpzQueries, AreReadWithTheirLabels) {
  constexpr std::size_t count = 1300;
  std::vector<std::uint8_t> labels;
  for (std::size_t i = 0; i < count; ++i) labels.push_back(i % 3 == 0 ? 1 : 0);
  const std::vector<std::string> arrays{
      tests::array("<f8", {count, 8, 3}, coordinates<double>(count)),
      tests::array("<f4", {count, 8, 3}, coordinates<float>(count))};
  for (const std::string& queries : arrays) {
    for (const bool is_compressed : {false, true}) {
      NpyDataset source(
          write({{"queries.npy", queries}, {"collides.npy", tests::array("|b1", {count}, labels)}},
                is_compressed),
          {});
      EXPECT_EQ(source.kind(), Kind::edge_edge);
      const auto records = read_all(source);
      EXPECT_EQ(source.progress(), 1.0);
      ASSERT_EQ(records.size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(records[i].index, i);
        EXPECT_EQ(records[i].collides, i % 3 == 0);
        for (std::size_t k = 0; k < size; ++k) {
          EXPECT_EQ(records[i].query.straight().coordinates.at(k),
                    static_cast<double>(i) + static_cast<double>(k) / 32);
        }
      }
    }
  }
  NpyDataset unlabelled(write({{"queries.npy", arrays[0]}}), {});
  EXPECT_FALSE(read_all(unlabelled).front().collides.has_value());
}

TEST_F(NpzQueries, ThatAreNoneAreErrors) {
  std::vector<double> numbers = coordinates<double>(3);
  const auto queries = [&](const std::vector<std::uint64_t>& shape) {
    return std::pair<const std::string, std::string>("queries.npy",
                                                     tests::array("<f8", shape, numbers));
  };
  EXPECT_EQ(error_with({queries({24, 3})}),
            "a_ee.npz: queries: shape (24, 3), expected (N, 8, 3), or (N, K+1, 4, 3) for curves of "
            "degree K up to 8, or (N, K+1, 4, 4) with weights");
  EXPECT_EQ(error_with({queries({4, 8, 3})}),
            "a_ee.npz: queries: 576 bytes of data do not fit shape (4, 8, 3) of dtype \"<f8\"");
  const std::vector<std::uint8_t> labels{1};
  EXPECT_EQ(error_with({queries({3, 8, 3}), {"collides.npy", tests::array("|b1", {1}, labels)}}),
            "a_ee.npz: collides: shape (1), expected (3)");
  numbers[size + 4] = std::nan("");
  EXPECT_EQ(error_with({queries({3, 8, 3})}), "a_ee.npz: query 1, point 1, y: not finite");
  EXPECT_EQ(read_survivors(write({queries({3, 8, 3})}), folder_.path()).records.size(), 2U);
}

}  // namespace
}  // namespace touchstone::verify::data::npy_dataset_test

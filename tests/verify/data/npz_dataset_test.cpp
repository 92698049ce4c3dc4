#include "verify/data/npz_dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::npz_dataset_test {
namespace {

using test::error_of;
using test::read_all;
using test::read_survivors;
using test::TemporaryFolder;

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
      NpzDataset source(write(members), {});
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
      NpzDataset source(
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
          EXPECT_EQ(records[i].query.coordinates.at(k),
                    static_cast<double>(i) + static_cast<double>(k) / 32);
        }
      }
    }
  }
  NpzDataset unlabelled(write({{"queries.npy", arrays[0]}}), {});
  EXPECT_FALSE(read_all(unlabelled).front().collides.has_value());
}

TEST_F(NpzQueries, ThatAreNotFiniteAreSkippedOnDemand) {
  std::vector<double> numbers = coordinates<double>(3);
  numbers[size + 4] = std::nan("");
  const std::map<std::string, std::string> members{
      {"queries.npy", tests::array("<f8", {3, 8, 3}, numbers)}};
  EXPECT_EQ(error_with(members), "a_ee.npz: query 1, point 1, y: not finite");
  NpzDataset source(write(members), {.keep_going = true});
  EXPECT_EQ(read_all(source).size(), 2U);
  EXPECT_EQ(source.skipped(), 1U);
}

TEST_F(NpzQueries, OfAnotherShapeOrTypeAreErrors) {
  const std::vector<double> numbers = coordinates<double>(2);
  const std::string queries = tests::array("<f8", {2, 8, 3}, numbers);
  EXPECT_EQ(error_with({{"V.npy", queries}}), "a_ee.npz: queries: No such file");
  EXPECT_EQ(error_with({{"queries.npy", tests::array("<f8", {16, 3}, numbers)}}),
            "a_ee.npz: queries: shape (16, 3), expected (N, 8, 3)");
  EXPECT_EQ(error_with({{"queries.npy", tests::array("<i8", {2, 8, 3}, numbers)}}),
            "a_ee.npz: queries: dtype \"<i8\", expected <f4 or <f8");
  EXPECT_EQ(error_with({{"queries.npy", tests::array("<f8", {3, 8, 3}, numbers)}}),
            "a_ee.npz: queries: the array ends early");
  const std::vector<std::uint8_t> labels{1};
  EXPECT_EQ(
      error_with({{"queries.npy", queries}, {"collides.npy", tests::array("|b1", {1}, labels)}}),
      "a_ee.npz: collides: shape (1), expected (2)");
}

}  // namespace
}  // namespace touchstone::verify::data::npz_dataset_test

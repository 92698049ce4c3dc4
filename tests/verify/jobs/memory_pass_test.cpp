#include "verify/jobs/memory_pass.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/random.hpp"
#include "touchstone/query.hpp"

namespace touchstone::verify::jobs::memory_pass_test {
namespace {

std::vector<Query> random_queries(std::size_t count) {
  tests::Random random(count);
  std::vector<Query> queries(count);
  for (Query& query : queries) {
    for (double& x : query.coordinates) x = std::bit_cast<double>(random.bits());
  }
  return queries;
}

std::uint64_t fold(const std::vector<Query>& queries) {
  std::uint64_t all = 0;
  for (const Query& query : queries) {
    for (const double x : query.coordinates) all ^= std::bit_cast<std::uint64_t>(x);
  }
  return all;
}

TEST(MemoryPass, ReadsEveryCoordinateOfAnyNumberOfQueries) {
  for (std::size_t count = 0; count < 20; ++count) {
    const auto queries = random_queries(count);
    EXPECT_EQ(memory_pass(queries), fold(queries)) << count;
  }
  const auto many = random_queries(100'003);
  EXPECT_EQ(memory_pass(many), fold(many));
}

TEST(MemoryPass, FillsUpTheLastWord) {
  EXPECT_EQ(memory_pass(std::vector<unsigned char>{}), 0U);
  EXPECT_EQ(memory_pass(std::vector<std::uint32_t>{1, 2, 4}), (std::uint64_t{2} << 32U) ^ 5U);
  std::vector<unsigned char> bytes(10'001);
  bytes.back() = 3;
  EXPECT_EQ(memory_pass(bytes), 3U) << "the last byte is the first of its word";
}

}  // namespace
}  // namespace touchstone::verify::jobs::memory_pass_test

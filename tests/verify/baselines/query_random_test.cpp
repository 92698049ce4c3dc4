#include "verify/baselines/query_random.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/queries.hpp"

namespace touchstone::baselines::query_random_test {
namespace {

TEST(RandomOf, RepeatsForAQueryAndDiffersBetweenQueries) {
  const Query query = tests::over_triangle(1, 1, 1, -1).query;
  Random first = random_of(query), again = random_of(query);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first.uniform(0, 1), again.uniform(0, 1));
  std::set<double> values;
  for (std::size_t i = 0; i < 24; ++i) {
    Query other = query;
    other.coordinates[i] += 1.0;
    values.insert(random_of(other).uniform(0, 1));
  }
  EXPECT_EQ(values.size(), 24U);
}

TEST(RandomOf, IsUniformInItsRange) {
  Random random = random_of(Query{});
  std::array<int, 10> counts{};
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-1, 1);
    ASSERT_GE(x, -1.0);
    ASSERT_LT(x, 1.0);
    ++counts.at(static_cast<std::size_t>((x + 1.0) * 5.0));
  }
  for (const int count : counts) EXPECT_NEAR(count, 1000, 200);
}

}  // namespace
}  // namespace touchstone::baselines::query_random_test

#include "verify/jobs/timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace touchstone::verify::jobs::statistics_test {
namespace {

using Positions = std::vector<std::size_t>;

TEST(Statistics, QuantileIsTheLeastValueThatEnoughDoNotExceed) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 50.0);
  EXPECT_EQ(quantile(values, 0.501), 51.0);
  EXPECT_EQ(quantile(values, 0.99), 99.0);
  EXPECT_EQ(quantile(values, 1.0), 100.0);
  EXPECT_EQ(quantile({5.0}, 0.99), 5.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(SpreadSample, HasTheCountAskedForAscendingAndWithoutRepetition) {
  for (const std::size_t size : {1U, 2U, 10U, 64U, 1000U, 1024U, 99'991U}) {
    for (const std::size_t count : {size / 7, size / 2, size - 1}) {
      const Positions sample = spread_sample(size, count);
      ASSERT_EQ(sample.size(), count) << size;
      const auto not_ascending = std::ranges::adjacent_find(sample, std::ranges::greater_equal());
      EXPECT_EQ(not_ascending, sample.end()) << size;
      EXPECT_TRUE(sample.empty() || sample.back() < size);
    }
  }
}

TEST(SpreadSample, ContainsEverySmallerOne) {
  const Positions large = spread_sample(5000, 700);
  for (const std::size_t count : {1U, 16U, 333U, 699U}) {
    EXPECT_TRUE(std::ranges::includes(large, spread_sample(5000, count))) << count;
  }
}

TEST(SpreadSample, LeavesNoPartOfTheQueriesOut) {
  static constexpr std::size_t size = 1'000'000, count = 1000;
  Positions sample = spread_sample(size, count);
  sample.push_back(size);
  std::size_t previous = 0;
  for (const std::size_t position : sample) {
    EXPECT_LE(position - previous, 4 * size / count);
    previous = position;
  }
}

TEST(SpreadSample, FallsIntoStepWithNoPeriod) {
  // The built-in set has queries of one sort at odd places, and families of 1000 in a row.
  for (const std::size_t period : {2U, 4U, 8U, 10U, 1000U}) {
    std::vector<int> collisions(period);
    const Positions sample = spread_sample(31'000, 8000);
    for (const std::size_t position : sample) ++collisions[position % period];
    const double expected = 8000.0 / static_cast<double>(period);
    for (const int collision : collisions)
      EXPECT_NEAR(collision, expected, 0.5 * expected + 2.0) << period;
  }
}

}  // namespace
}  // namespace touchstone::verify::jobs::statistics_test

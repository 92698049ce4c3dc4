#include "verify/jobs/timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/query_groups.hpp"

namespace touchstone::verify::jobs::timing_test {
namespace {

using tests::FunctionMethod;
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

TEST(SpreadSample, HasTheCountAskedForAscendingAndContainsEverySmallerOne) {
  for (const std::size_t size : {1U, 2U, 10U, 64U, 1000U, 1024U, 99'991U}) {
    Positions smaller;
    for (const std::size_t count : {size / 7, size / 2, size - 1}) {
      const Positions sample = spread_sample(size, count);
      ASSERT_EQ(sample.size(), count) << size;
      const auto not_ascending = std::ranges::adjacent_find(sample, std::ranges::greater_equal());
      EXPECT_EQ(not_ascending, sample.end()) << size;
      EXPECT_TRUE(sample.empty() || sample.back() < size);
      EXPECT_TRUE(std::ranges::includes(sample, smaller)) << size;
      smaller = sample;
    }
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

TEST(Timing, ShortWorkIsDoneSeveralTimes) {
  EXPECT_EQ(calls_for(1e9), 1U);
  EXPECT_GT(calls_for(1e3), 1000U);
  int calls = 0;
  EXPECT_GE(time_of(7, [&] { ++calls; }), 0.0);
  EXPECT_EQ(calls, 7);
}

TEST(TimedSolver, ItsSampleGrowsAsLongAsItIsFast) {
  const data::QueryGroup group = tests::falling_group(1000);
  const FunctionMethod fast_one(tests::always_no), slow_one(tests::slow_no);
  const auto quick = solvers::solver_in_process(fast_one, {}),
             slow = solvers::solver_in_process(slow_one, {});
  const auto size_with = [&](const solvers::Solver& solver, double seconds,
                             const std::atomic<bool>* stop = nullptr) {
    TimedSolver timed(solver, group, {});
    timed.choose_sample(seconds, stop);
    return timed.queries().size();
  };
  EXPECT_EQ(size_with(*quick, 10.0), 1000U);
  const std::size_t size = size_with(*slow, 0.05);
  EXPECT_GE(size, 16U);
  EXPECT_LE(size, 64U) << "a millisecond each";
  const std::atomic<bool> stop = true;
  EXPECT_EQ(size_with(*quick, 10.0, &stop), 16U);
}

TEST(Sample, OfCurvesIsCopiedWhole) {
  const data::QueryGroup group = tests::curved_group(ContactKind::edge_edge, 40);
  const auto some = sample_of(group, 16), all = sample_of(group, 100);
  EXPECT_EQ(AnyShape(some->queries), (AnyShape{.kind = ContactKind::edge_edge, .degree = 2}));
  ASSERT_EQ(some->queries.size(), 16U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_TRUE(std::ranges::equal(some->queries.row(i), group.queries().row(some->positions[i])));
  }
  EXPECT_EQ(all->queries.numbers.data(), group.queries().numbers.data()) << "no copy";
  EXPECT_EQ(all->queries.size(), 40U);
}

TEST(TimedSolver, TakesCurvesOrLinesOfWhateverKind) {
  const AnyShape line{.kind = ContactKind::edge_edge},
      parabola{.kind = ContactKind::edge_edge, .degree = 2};
  const fast::Terms lines{.contacts = {true, false}},
      curves{.contacts = {true, false}, .straight = false, .most_degree = 8};
  EXPECT_TRUE(takes_curves(lines, line));
  EXPECT_FALSE(takes_curves(lines, parabola));
  EXPECT_TRUE(takes_curves(curves, parabola));
  EXPECT_FALSE(takes_curves(curves, line));
}

TEST(TimedSolver, TimesQueriesAlone) {
  const data::QueryGroup group = tests::falling_group(40);
  const FunctionMethod method(tests::slow_no);
  const auto solver = solvers::solver_in_process(method, {});
  TimedSolver timed(*solver, group, {});
  timed.take(sample_of(group, 20));
  const auto times = timed.time_singles(10, 1e-3, nullptr);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->size(), 10U);
  EXPECT_GE(std::ranges::min(*times), 0.9e6);
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(timed.time_singles(10, 1.0, &stop));
}

}  // namespace
}  // namespace touchstone::verify::jobs::timing_test

#include "verify/jobs/timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/methods.hpp"
#include "tests/support/queries.hpp"
#include "verify/jobs/statistics.hpp"

namespace touchstone::verify::jobs::timing_test {
namespace {

using fast::Answer;
using fast::Verdict;
using tests::FunctionMethod;

/// Vertices over a triangle at different heights, of which every tenth falls through it.
data::QueryGroup falling(std::size_t count) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < count; ++i) {
    const double start = 1.0 + 0.001 * static_cast<double>(i);
    queries.push_back(tests::over_triangle(1, 1, start, i % 10 == 0 ? -1.0 : 0.5).query);
  }
  return {"falling", Kind::vertex_face, std::move(queries)};
}

Answer no(Kind, const Query&) { return {.verdict = Verdict::no}; }

Answer slow_no(Kind, const Query&) {
  const double start = base::thread_nanoseconds();
  while (base::thread_nanoseconds() - start < 1e6) continue;
  return {.verdict = Verdict::no};
}

TEST(Timing, RotatesTheOrderOfTheRepetitions) {
  using Order = std::vector<std::size_t>;
  EXPECT_EQ(order_of_repetition(3, 0), (Order{0, 1, 2}));
  EXPECT_EQ(order_of_repetition(3, 1), (Order{1, 2, 0}));
  EXPECT_EQ(order_of_repetition(3, 2), (Order{2, 0, 1}));
  EXPECT_EQ(order_of_repetition(3, 3), (Order{0, 1, 2}));
}

TEST(Timing, MedianAndMinimumAreThoseOfTheRepetitions) {
  const Times times{.repetitions = {3.0, 1.0, 8.0}};
  EXPECT_EQ(times.median(), 3.0);
  EXPECT_EQ(times.min(), 1.0);
  EXPECT_TRUE(std::isnan(Times{}.median()));
}

TEST(Timing, TheClockTakesItsTime) {
  EXPECT_GE(clock_nanoseconds(), 0.0);
  EXPECT_LT(clock_nanoseconds(), 1e5);
}

TEST(Timing, ShortWorkIsDoneSeveralTimes) {
  EXPECT_EQ(calls_for(1e9), 1U);
  EXPECT_GT(calls_for(1e3), 1000U);
  int calls = 0;
  EXPECT_GE(time_of(7, [&] { ++calls; }), 0.0);
  EXPECT_EQ(calls, 7);
}

TEST(TimedSolver, AnswersAnEvenlySpreadSample) {
  const data::QueryGroup group = falling(100);
  Samples samples(group);
  const FunctionMethod method(tests::true_answer);
  const auto solver = solvers::solver_in_process(method, {});
  TimedSolver timed(*solver, samples, {});
  EXPECT_TRUE(timed.queries().empty());
  for (const std::size_t count : {30U, 100U, 1000U}) {
    timed.take(count);
    EXPECT_EQ(timed.positions(), spread_sample(100, count));
    timed.repeat();
    ASSERT_EQ(timed.answers().size(), timed.queries().size());
    for (std::size_t i = 0; i < timed.queries().size(); ++i) {
      EXPECT_EQ(timed.queries()[i], group.queries()[timed.positions()[i]]);
      const bool collides = timed.positions()[i] % 10 == 0;
      EXPECT_EQ(timed.answers()[i].verdict, collides ? Verdict::yes : Verdict::no);
    }
  }
  EXPECT_EQ(timed.times().repetitions.size(), 3U);
  EXPECT_GT(timed.seconds_spent(), 0.0);
}

TEST(Samples, OfOneSizeAreOneInMemory) {
  const data::QueryGroup group = falling(100);
  Samples samples(group);
  const auto thirty = samples.of(30), again = samples.of(30), all = samples.of(100);
  EXPECT_EQ(thirty.get(), again.get());
  EXPECT_EQ(samples.of(1000).get(), all.get());
  EXPECT_EQ(thirty->queries.data(), thirty->copies.data());
  EXPECT_EQ(all->queries.data(), group.queries().data()) << "no copies of all there are";
}

TEST(TimedSolver, ItsSampleGrowsAsLongAsItAndItsCompanionAreFast) {
  const data::QueryGroup group = falling(1000);
  Samples samples(group);
  const FunctionMethod fast_one(no), slow_one(slow_no);
  const auto quick = solvers::solver_in_process(fast_one, {}),
             slow = solvers::solver_in_process(slow_one, {});
  const auto size_with = [&](const solvers::Solver& solver, const SampleLimits& limits) {
    TimedSolver timed(solver, samples, {});
    timed.choose_sample(limits);
    return timed.queries().size();
  };
  EXPECT_EQ(size_with(*quick, {.most = 1000, .seconds = 10.0}), 1000U);
  EXPECT_EQ(size_with(*quick, {.most = 77, .seconds = 10.0}), 77U);
  for (const SampleLimits& limits :
       {SampleLimits{.most = 1000, .seconds = 0.05},
        SampleLimits{.most = 1000, .seconds = 0.05, .companion = slow.get()}}) {
    const std::size_t size = size_with(limits.companion == nullptr ? *slow : *quick, limits);
    EXPECT_GE(size, 16U);
    EXPECT_LE(size, 64U) << "a millisecond each";
  }
  const std::atomic<bool> stop = true;
  EXPECT_EQ(size_with(*quick, {.most = 1000, .seconds = 10.0, .stop = &stop}), 16U);
}

TEST(TimedSolver, TimesQueriesAlone) {
  const data::QueryGroup group = falling(40);
  Samples samples(group);
  const FunctionMethod method(slow_no);
  const auto solver = solvers::solver_in_process(method, {});
  TimedSolver timed(*solver, samples, {});
  timed.take(20);
  const auto times = timed.time_singles(10, 1e-3, nullptr);
  ASSERT_TRUE(times);
  EXPECT_EQ(times->size(), 10U);
  EXPECT_GE(std::ranges::min(*times), 0.9e6);
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(timed.time_singles(10, 1.0, &stop));
}

TEST(TimedSolver, JudgesTheQueriesWhoseTruthIsKnown) {
  const data::QueryGroup group = falling(100);
  Samples samples(group);
  const double height = group.queries()[10].at(0, 0, 2);
  const FunctionMethod method([height](Kind kind, const Query& query) {
    if (query.at(0, 0, 2) == height) throw std::runtime_error("thrown");
    return no(kind, query);
  });
  const auto solver = solvers::solver_in_process(method, {});
  TimedSolver timed(*solver, samples, {});
  timed.take(100);
  timed.repeat();
  std::vector<judge::GroundTruth> truths;
  for (const std::uint64_t position : {0U, 10U, 11U, 90U}) {
    truths.push_back({.index = position, .collides = position != 11, .toi = {{0.25, 0.25}}});
  }
  const judge::Judgement judgement = timed.judge(truths);
  EXPECT_EQ(judgement.queries, 4U);
  EXPECT_EQ(judgement.count(judge::Fault::false_negative), 2U);
  EXPECT_EQ(judgement.count(judge::Fault::exception), 1U);
  ASSERT_EQ(judgement.wrong_answers.size(), 3U);
  EXPECT_EQ(judgement.wrong_answers[1].answer, "exception: thrown");
}

}  // namespace
}  // namespace touchstone::verify::jobs::timing_test

#include "verify/jobs/solve.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/memory_source.hpp"
#include "tests/support/methods.hpp"

namespace touchstone::verify::jobs::solve_test {
namespace {

using fast::Answer;
using fast::Verdict;
using tests::MemorySource;

/// Queries that determine their answers: verdict number `index` mod 5, of which 4 is no, like 0.
std::vector<data::RecordedQuery> scripted(std::uint64_t count) {
  std::vector<data::RecordedQuery> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    records.push_back({.query = {{static_cast<double>(i % 5 % 4), static_cast<double>(i)}},
                       .index = i + 10,
                       .collides = std::nullopt,
                       .toi = std::nullopt});
  }
  return records;
}

Answer obey(Kind, const Query& query) {
  return {.verdict = static_cast<Verdict>(static_cast<int>(query.coordinates[0])),
          .toi_lower = query.coordinates[1]};
}

TEST(Solve, CountsAndHandsOutTheAnswersInOrder) {
  const tests::FunctionMethod method(obey);
  const auto solver = solvers::solver_in_process(method, {});
  for (const unsigned threads : {1U, 3U}) {
    MemorySource source(Kind::edge_edge, scripted(10000));
    std::uint64_t next = 0;
    const auto on_answer = [&](std::uint64_t index, const Answer& answer,
                               const judge::Failure* failure) {
      ASSERT_EQ(failure, nullptr);
      ASSERT_EQ(index, next + 10);
      ASSERT_EQ(answer.verdict, static_cast<Verdict>(next % 5 % 4));
      ASSERT_EQ(answer.toi_lower, static_cast<double>(next));
      ++next;
    };
    const SolveResult result = solve(source, *solver, {.threads = threads, .on_answer = on_answer});
    EXPECT_EQ(next, 10000U);
    EXPECT_EQ(result.queries, 10000U);
    EXPECT_EQ(result.no, 4000U);
    EXPECT_EQ(result.yes, 2000U);
    EXPECT_EQ(result.undecided, 2000U);
    EXPECT_EQ(result.errors, 2000U);
    EXPECT_EQ(result.failures[static_cast<std::size_t>(judge::Fault::no_verdict)], 2000U);
    EXPECT_EQ(result.failures[static_cast<std::size_t>(judge::Fault::undecided)], 2000U);
    EXPECT_EQ(result.skipped, 3U);
    EXPECT_EQ(result.rounded, 5U);
    EXPECT_GT(result.nanoseconds_per_query(), 0.0);
    EXPECT_FALSE(result.reading_error);
    EXPECT_FALSE(result.interrupted);
  }
}

TEST(Solve, AnErrorOrAStopLosesNothingBeforeIt) {
  const tests::FunctionMethod method(obey);
  const auto solver = solvers::solver_in_process(method, {});
  MemorySource broken(Kind::edge_edge, scripted(3000));
  broken.fail_at(2500, "row is broken");
  const SolveResult to_error = solve(broken, *solver);
  EXPECT_EQ(to_error.queries, 2500U);
  EXPECT_EQ(to_error.reading_error, "row is broken");

  std::atomic<bool> stop = false;
  MemorySource source(Kind::edge_edge, scripted(200000));
  std::uint64_t seen = 0;
  const SolveResult stopped =
      solve(source, *solver,
            {.on_answer = [&](std::uint64_t, const Answer&,
                              const judge::Failure*) { stop = ++seen > 100; },
             .stop = &stop});
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_EQ(stopped.queries, seen);
  EXPECT_GT(seen, 100U);
  EXPECT_LT(seen, 100000U);
}

TEST(Solve, ResultsAddUp) {
  SolveResult sum{.queries = 1, .yes = 1, .unplaced_crashes = 1, .nanoseconds = 10.0};
  sum += SolveResult{.queries = 4,
                     .yes = 1,
                     .no = 1,
                     .undecided = 1,
                     .errors = 1,
                     .unplaced_crashes = 2,
                     .nanoseconds = 40.0,
                     .skipped = 6,
                     .rounded = 7,
                     .interrupted = true};
  EXPECT_EQ(sum.queries, 5U);
  EXPECT_EQ(sum.yes, 2U);
  EXPECT_EQ(sum.no + sum.undecided + sum.errors, 3U);
  EXPECT_EQ(sum.unplaced_crashes, 3U);
  EXPECT_EQ(sum.skipped, 6U);
  EXPECT_EQ(sum.rounded, 7U);
  EXPECT_EQ(sum.nanoseconds_per_query(), 10.0);
  EXPECT_TRUE(sum.interrupted);
  EXPECT_EQ(SolveResult{}.nanoseconds_per_query(), 0.0);
}

}  // namespace
}  // namespace touchstone::verify::jobs::solve_test

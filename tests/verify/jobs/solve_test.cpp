#include "verify/jobs/solve.hpp"

#include <gtest/gtest.h>

#include <cstdint>
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
                       .collides = {},
                       .toi = {}});
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

}  // namespace
}  // namespace touchstone::verify::jobs::solve_test

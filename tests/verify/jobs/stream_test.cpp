#include "verify/jobs/stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <vector>

#include "tests/support/memory_source.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::jobs::stream_test {
namespace {

using tests::MemorySource;

std::vector<data::RecordedQuery> numbered(std::uint64_t count) {
  std::vector<data::RecordedQuery> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    records.push_back({.query = {Kind::edge_edge, Query{{static_cast<double>(i)}}},
                       .index = i,
                       .collides = i % 2 == 0,
                       .toi = exact::Rational(static_cast<unsigned long>(i))});
  }
  return records;
}

/// A stream of numbered queries; collects their numbers in the order of output.
struct Collected {
  std::vector<std::uint64_t> indices;
  StreamResult result;
};

Collected collect(MemorySource& source, const StreamOptions& options) {
  Collected collected;
  const auto work = [&](const QueryBlock& block) -> BlockResult {
    return {.in_order = [&] {
      collected.indices.insert(collected.indices.end(), block.indices.begin(), block.indices.end());
    }};
  };
  collected.result = stream(source, work, options);
  return collected;
}

TEST(Stream, AllComesOutInOrderWhateverTheNumberOfThreads) {
  for (const unsigned threads : {1U, 2U, 5U}) {
    MemorySource source(Kind::edge_edge, numbered(5 * QueryBlock::most_queries + 7));
    const Collected collected = collect(source, {.threads = threads});
    ASSERT_EQ(collected.indices.size(), 5 * QueryBlock::most_queries + 7);
    EXPECT_TRUE(std::ranges::is_sorted(collected.indices));
    EXPECT_EQ(collected.indices.back(), 5 * QueryBlock::most_queries + 6);
    EXPECT_EQ(collected.result.skipped, 3U);
    EXPECT_EQ(collected.result.rounded, 5U);
    EXPECT_FALSE(collected.result.error);
    EXPECT_FALSE(collected.result.interrupted);
  }
}

TEST(Stream, AnErrorOfTheSourceLosesNothingBeforeIt) {
  MemorySource source(Kind::edge_edge, numbered(3 * QueryBlock::most_queries));
  source.fail_at(QueryBlock::most_queries + 5, "row is broken");
  const Collected collected = collect(source, {});
  EXPECT_EQ(collected.indices.size(), QueryBlock::most_queries + 5);
  EXPECT_EQ(collected.result.error, "row is broken");
  EXPECT_FALSE(collected.result.interrupted);
}

/// A source in which an interrupt ends the wait for query number 5.
class InterruptedSource final : public data::QuerySource {
 public:
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] QueryShape shape() const override { return {.kind = Kind::edge_edge}; }
  [[nodiscard]] std::optional<data::RecordedQuery> next() override {
    if (position_ == 5) throw io::Interrupted();
    return data::RecordedQuery{.query = {}, .index = position_++, .collides = {}, .toi = {}};
  }
  [[nodiscard]] double progress() const override { return 0.0; }

 private:
  std::string name_ = "interrupted";
  std::uint64_t position_ = 0;
};

TEST(Stream, AnInterruptOfTheSourceIsNoErrorAndLosesNothingBeforeIt) {
  InterruptedSource source;
  std::size_t queries = 0;
  const auto work = [&](const QueryBlock& block) -> BlockResult {
    return {.in_order = [&] { queries += block.size(); }};
  };
  const StreamResult result = stream(source, work, {});
  EXPECT_TRUE(result.interrupted);
  EXPECT_FALSE(result.error);
  EXPECT_EQ(queries, 5U);
}

TEST(Stream, AnExceptionOfTheWorkEndsItAndIsReported) {
  MemorySource source(Kind::edge_edge, numbered(20 * QueryBlock::most_queries));
  std::size_t blocks = 0;
  const auto work = [&](const QueryBlock& block) -> BlockResult {
    if (block.indices.front() == 10 * QueryBlock::most_queries)
      throw std::runtime_error("no memory left");
    return {.in_order = [&] { ++blocks; }};
  };
  EXPECT_EQ(stream(source, work, {.threads = 1}).error, "no memory left");
  EXPECT_LE(blocks, 10U);
}

TEST(Stream, AnIncompleteBlockIsTheLast) {
  MemorySource source(Kind::edge_edge, numbered(10 * QueryBlock::most_queries));
  std::vector<std::uint64_t> firsts;
  const auto work = [&](const QueryBlock& block) -> BlockResult {
    const std::uint64_t first = block.indices.front();
    return {.in_order = [&firsts, first] { firsts.push_back(first); },
            .complete = first != 2 * QueryBlock::most_queries};
  };
  const StreamResult result = stream(source, work, {.threads = 4});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(firsts, (std::vector<std::uint64_t>{0, QueryBlock::most_queries,
                                                2 * QueryBlock::most_queries}));
}

TEST(Passes, CoverEachQueryOnceWhateverTheSpan) {
  for (const std::size_t queries : {1U, 15U, 16U, 17U, 1000U}) {
    for (const std::size_t span : {1U, 16U, 40U, 1000U, 1000000U}) {
      Passes passes(queries, nullptr);
      std::vector<std::atomic<int>> visits(queries);
      passes.run(span, [&](std::size_t first, std::size_t count) {
        EXPECT_EQ(first % Passes::unit, 0U);
        EXPECT_LE(count, std::max(span, Passes::unit));
        for (std::size_t i = first; i < first + count; ++i) ++visits.at(i);
        return true;
      });
      EXPECT_TRUE(std::ranges::all_of(visits, [](const auto& count) { return count == 1; }));
      EXPECT_EQ(passes.complete(), queries);
    }
  }
}

TEST(Passes, AStopLeavesAPrefixThatAllPassesHaveSeen) {
  std::atomic<bool> stop = false;
  Passes passes(160, &stop);
  EXPECT_EQ(passes.complete(), 160U) << "no pass, nothing left to do";
  std::mutex mutex;
  std::set<std::size_t> first_pass, second_pass;
  passes.run(16, [&](std::size_t first, std::size_t) {
    const std::scoped_lock lock(mutex);
    first_pass.insert(first);
    return true;
  });
  EXPECT_EQ(first_pass.size(), 10U);
  EXPECT_EQ(passes.complete(), 160U);
  passes.run(32, [&](std::size_t first, std::size_t) {
    const std::scoped_lock lock(mutex);
    second_pass.insert(first);
    stop = true;
    return true;
  });
  EXPECT_LT(second_pass.size(), 5U);
  std::size_t expected = 0;
  while (second_pass.contains(expected)) expected += 32;
  EXPECT_EQ(passes.complete(), expected);
}

TEST(Passes, WhatTheWorkIsNotDoneWithIsNotComplete) {
  Passes passes(160, nullptr);
  passes.run(32, [](std::size_t first, std::size_t) { return first != 64; });
  EXPECT_EQ(passes.complete(), 64U);
}

}  // namespace
}  // namespace touchstone::verify::jobs::stream_test

#include "verify/judge/ground_truth_cache.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "tests/support/queries.hpp"

namespace touchstone::verify::judge::ground_truth_cache_test {
namespace {

/// Vertices over a triangle that fall from height 1: through it, to half of it, and so on.
data::QueryGroup falling() {
  std::vector<Query> queries;
  for (const double end : {-1.0, 0.5, -3.0, 0.25}) {
    queries.push_back(tests::over_triangle(1, 1, 1, end).query);
  }
  return {"falling", Kind::vertex_face, std::move(queries)};
}

using Positions = std::vector<std::size_t>;

/// A stopped cache returns what it knows without the oracle.
TEST(GroundTruthCache, AskTheOracleOnceAQueryAndSeparation) {
  const data::QueryGroup group = falling();
  GroundTruthCache truths(group);
  const std::atomic<bool> stop = true;
  const auto known = [&](const Separation& separation, const Positions& positions) {
    return truths.of(separation, positions, &stop).size();
  };
  EXPECT_EQ(truths.of({}, Positions{0, 2}).size(), 2U);
  EXPECT_EQ(known({}, {0, 2, 1}), 2U);
  EXPECT_EQ(truths.of({}, Positions{0, 1, 2, 3}).size(), 4U);
  EXPECT_EQ(known({}, {3, 2, 1, 0}), 4U);
  EXPECT_EQ(known({.distance = 0.0, .norm = Norm::l2}, {3}), 1U)
      << "at distance 0 the norm does not matter";
  const Separation half{.distance = 0.5, .norm = Norm::linf};
  EXPECT_EQ(known(half, {3}), 0U);
  EXPECT_EQ(truths.of(half, Positions{3, 3}).size(), 2U);
  EXPECT_EQ(known(half, {3}), 1U);
}

TEST(GroundTruthCache, AreAboutTheSeparation) {
  const data::QueryGroup group = falling();
  GroundTruthCache truths(group);
  const Positions all{0, 1, 2, 3};
  const auto collisions = [&](const Separation& separation) {
    std::size_t count = 0;
    for (const GroundTruth& truth : truths.of(separation, all)) count += truth.collides ? 1U : 0U;
    return count;
  };
  EXPECT_EQ(collisions({}), 2U);
  EXPECT_EQ(collisions({.distance = 0.25, .norm = Norm::l2}), 3U);
  EXPECT_EQ(collisions({.distance = 0.5, .norm = Norm::linf}), 4U);
}

TEST(GroundTruthCache, OnceStoppedNoMoreAreDecided) {
  const data::QueryGroup group = falling();
  GroundTruthCache truths(group);
  (void)truths.of({}, Positions{0});
  const std::atomic<bool> stop = true;
  const std::vector<GroundTruth> known = truths.of({}, Positions{0, 1}, &stop);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].index, 0U);
}

TEST(GroundTruthCache, PositionsBeyondTheGroupAreRefused) {
  const data::QueryGroup group = falling();
  GroundTruthCache truths(group);
  EXPECT_THROW((void)truths.of({}, Positions{4}), std::out_of_range);
}

}  // namespace
}  // namespace touchstone::verify::judge::ground_truth_cache_test

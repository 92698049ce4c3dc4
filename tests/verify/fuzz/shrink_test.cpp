#include "verify/fuzz/shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <stdexcept>
#include <vector>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/decimal.hpp"

namespace touchstone::verify::fuzz::shrink_test {
namespace {

using tests::PosedQuery;
using tests::Random;

using Predicate = std::function<bool(const Query&)>;

Plainness of_itself(Kind kind, const Query& query) { return plainness(kind, query, query); }

std::uint64_t length_of(Kind kind, const Query& query) { return of_itself(kind, query).length; }

std::vector<PosedQuery> random_queries(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<PosedQuery> result;
  for (int i = 0; i < count; ++i) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      result.push_back({kind, tests::full_significand_query(random)});
    }
  }
  return result;
}

// ---- Known ends ---------------------------------------------------------------------------------

/// Expects only 0 and 1, and no degenerate primitives.
void expect_plain(Kind kind, const Query& query) {
  EXPECT_EQ(degeneracy(kind, query), 0U) << PosedQuery{kind, query};
  for (const double x : magnitudes(query)) EXPECT_EQ(x, 1.0) << PosedQuery{kind, query};
}

TEST(Shrink, LeavesThePlainestQueryIfAllFail) {
  for (const auto& [kind, query] : random_queries(1, 20)) {
    const Query least = shrink(kind, query, [](const Query&) { return true; });
    expect_plain(kind, least);
    EXPECT_LE(length_of(kind, least), 11U + 10U * 2U) << PosedQuery{kind, least};
  }
}

/// A fault of one scale is shown at that scale, and a fault of all scales at the original one.
TEST(Shrink, StaysAtTheOriginalsScale) {
  const Query base = tests::over_triangle(1, 1, 1, -2).query;
  for (const double scale : {0.013, 1.0, 87.0}) {
    Query query = base;
    for (double& x : query.coordinates) x *= scale;
    const auto falls = [](const Query& some) {
      return some.at(0, 0, 2) > 0.0 && some.at(1, 0, 2) < 0.0;
    };
    const Query least = shrink(Kind::vertex_face, query, falls);
    EXPECT_TRUE(falls(least));
    EXPECT_LE(std::abs(size_exponent(least) - size_exponent(query)), 3);
    for (const double x : magnitudes(least)) EXPECT_EQ(generate::shortest_decimal(x).count, 1) << x;
  }
}

TEST(Shrink, ComesBackFromTheEndsOfTheRange) {
  for (const int exponent : {-1070, -1000, -500, 500, 960}) {
    Query query = tests::over_triangle(1, 1, 1, -2).query;
    for (double& x : query.coordinates) x = std::ldexp(x, exponent);
    const Query least = shrink(Kind::vertex_face, query, [](const Query& some) {
      return some.at(0, 0, 2) > 0.0 && some.at(1, 0, 2) < 0.0;
    });
    expect_plain(Kind::vertex_face, least);
    EXPECT_EQ(least.at(0, 0, 2), 1.0) << exponent;
    EXPECT_EQ(least.at(1, 0, 2), -1.0) << exponent;
  }
}

// ---- Faults of methods --------------------------------------------------------------------------

/// True if the certified solver misses the query after rounding to floats.
bool is_missed_in_float(Kind kind, const Query& query) {
  Query rounded = query;
  for (double& x : rounded.coordinates) x = static_cast<double>(static_cast<float>(x));
  return fast::solve(kind, rounded).verdict == fast::Verdict::no &&
         exact::decide(kind, query).collides();
}

TEST(Shrink, MakesFindingsOfAMethodShort) {
  Random random(9);
  int missed = 0;
  for (int i = 0; i < tests::trials(48); ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const Query query = tests::near_contact_query(random, kind);
    if (!is_missed_in_float(kind, query)) continue;
    ++missed;
    const auto is_missed = [&](const Query& other) { return is_missed_in_float(kind, other); };
    const Query least = shrink(kind, query, is_missed);
    EXPECT_TRUE(is_missed(least)) << PosedQuery{kind, least};
    // Narrow contact, which hardly any change of one coordinate preserves.
    EXPECT_LE(length_of(kind, least), 600U) << PosedQuery{kind, least};
    EXPECT_GE(length_of(kind, query), 1400U);
  }
  EXPECT_GE(missed, tests::trials(48) / 16);
}

TEST(Shrink, FindsSmallIntegersForATimeOfImpact) {
  const auto is_late = [](const Query& query) {
    const exact::Decision truth = exact::decide(Kind::vertex_face, query);
    return truth.collides() && truth.toi->enclosure().lower > 0.6;
  };
  Random random(11);
  const Query base = tests::over_triangle(1, 1, 0.8, -0.4).query;
  for (int i = 0; i < tests::trials(8); ++i) {
    Query query = base;
    for (double& x : query.coordinates) x = 0.37 * (x + random.uniform(-0.01, 0.01));
    ASSERT_TRUE(is_late(query));
    const Query least = shrink(Kind::vertex_face, query, is_late);
    EXPECT_TRUE(is_late(least));
    for (const double x : least.coordinates) EXPECT_LE(std::abs(x), 3.0) << x;
    EXPECT_LE(length_of(Kind::vertex_face, least), 45U) << PosedQuery{Kind::vertex_face, least};
  }
}

// ---- Properties of every run --------------------------------------------------------------------

/// A condition that depends on many coordinates: a hash of the rounded differences.
Predicate fickle(std::uint64_t seed) {
  return [seed](const Query& query) {
    double sum = static_cast<double>(seed % 7U);
    for (std::size_t i = 0; i < 23; ++i) {
      sum += std::abs(query.coordinates[i] - query.coordinates[i + 1]) > 0.25 ? 1.0 : 0.0;
    }
    return std::fmod(sum, 3.0) != 0.0 && sum > 6.0;
  };
}

TEST(Shrink, AsksOnlyPlainerQueriesAndNoneTwice) {
  for (const auto& [kind, query] : random_queries(5, tests::trials(16))) {
    const Predicate fails = fickle(query.coordinates[0] > 0 ? 1 : 2);
    Query best = query;
    using Bits = std::array<std::uint64_t, 24>;
    std::set<Bits> asked{std::bit_cast<Bits>(query)};
    const Query least = shrink(kind, query, [&, kind = kind](const Query& other) {
      const Plainness of_other = plainness(kind, other, query);
      EXPECT_LT(of_other, plainness(kind, best, query));
      EXPECT_FALSE(of_other.is_worse_somewhere(plainness(kind, query, query)));
      EXPECT_TRUE(asked.insert(std::bit_cast<Bits>(other)).second);
      if (fails(other)) best = other;
      return fails(other);
    });
    EXPECT_EQ(least, best);
  }
}

TEST(Shrink, IsDeterministic) {
  for (const auto& [kind, query] : random_queries(6, tests::trials(16))) {
    const Predicate fails = fickle(query.coordinates[1] > 0 ? 1 : 2);
    EXPECT_EQ(shrink(kind, query, fails), shrink(kind, query, fails));
  }
}

TEST(Shrink, KeepsItsLimits) {
  for (const auto& [kind, query] : random_queries(7, 2)) {
    for (const std::uint64_t limit : {0U, 1U, 10U, 100U}) {
      std::uint64_t calls = 0;
      const auto count = [&](const Query&) {
        ++calls;
        return calls % 3 == 0;
      };
      const Query least = shrink(kind, query, count, {.most_calls = limit});
      EXPECT_LE(calls, limit);
      EXPECT_GE(calls, std::min<std::uint64_t>(limit, 10));
      EXPECT_EQ(least == query, limit < 3);
    }
    const auto never = [](const Query&) -> bool { throw std::logic_error("asked"); };
    EXPECT_EQ(shrink(kind, query, never, {.must_end = [] { return true; }}), query);
    EXPECT_THROW((void)shrink(kind, query, never), std::logic_error);
  }
}

}  // namespace
}  // namespace touchstone::verify::fuzz::shrink_test

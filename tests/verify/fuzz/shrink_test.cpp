#include "verify/fuzz/shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
#include "verify/fuzz/curved_generators.hpp"
#include "verify/fuzz/finding.hpp"
#include "verify/fuzz/plainness.hpp"
#include "verify/generate/everyday.hpp"

namespace touchstone::verify::fuzz::shrink_test {
namespace {

using tests::PosedQuery;
using tests::Random;

using Predicate = std::function<bool(const AnyQuery&)>;

AnyQuery any(const PosedQuery& posed) { return {posed.kind, posed.query}; }

std::uint64_t digits_in(const AnyQuery& query) { return plainness(query).digits; }

std::vector<AnyQuery> random_queries(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<AnyQuery> result;
  for (int i = 0; i < count; ++i) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      result.emplace_back(kind, tests::full_significand_query(random));
    }
  }
  return result;
}

// ---- Known ends ---------------------------------------------------------------------------------

/// Expects one number of one digit, and no degenerate primitives.
void expect_plain(const AnyQuery& query) {
  const Plainness plain = plainness(query);
  EXPECT_EQ(plain.shape, Shape::general) << as_points(query);
  EXPECT_EQ(plain.digits, 2U) << as_points(query);
}

bool falls(const AnyQuery& some) {
  return some.straight().at(0, 0, 2) > 0.0 && some.straight().at(1, 0, 2) < 0.0;
}

/// A fault of one scale is shown at that scale.
TEST(Shrink, StaysWhereTheFaultIs) {
  const auto falls_below_a_thousandth = [](const AnyQuery& query) {
    return falls(query) && size_exponent(query) < -10;
  };
  AnyQuery query = any(tests::over_triangle(1, 1, 1, -2));
  for (double& x : query.numbers()) x *= 0x1p-14;
  const AnyQuery least = shrink(query, falls_below_a_thousandth);
  EXPECT_TRUE(falls_below_a_thousandth(least));
  EXPECT_EQ(magnitudes(least).size(), 1U) << as_points(least);
  EXPECT_LE(digits_in(least), 6U) << as_points(least);
}

TEST(Shrink, ComesBackFromTheEndsOfTheRange) {
  for (const int exponent : {-1070, -1000, -500, 500, 960}) {
    AnyQuery query = any(tests::over_triangle(1, 1, 1, -2));
    for (double& x : query.numbers()) x = std::ldexp(x, exponent);
    const AnyQuery least = shrink(query, falls);
    expect_plain(least);
    EXPECT_TRUE(falls(least)) << exponent;
  }
}

// ---- Faults of methods --------------------------------------------------------------------------

/// True if the certified solver misses the query after rounding to floats.
bool is_missed_in_float(const AnyQuery& query) {
  const ContactKind kind = query.kind().contact();
  Query rounded = query.straight();
  for (double& x : rounded.coordinates) x = static_cast<double>(static_cast<float>(x));
  return fast::solve(kind, rounded).verdict == fast::Verdict::no &&
         exact::decide(kind, query.straight()).collides();
}

TEST(Shrink, MakesFindingsOfAMethodShort) {
  Random random(9);
  int missed = 0;
  for (int i = 0; i < tests::trials(48); ++i) {
    const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
    const AnyQuery query(kind, tests::near_contact_query(random, kind));
    if (!is_missed_in_float(query)) continue;
    ++missed;
    const AnyQuery least = shrink(query, is_missed_in_float);
    EXPECT_TRUE(is_missed_in_float(least)) << as_points(least);
    // Narrow contact, which hardly any change of one coordinate preserves.
    EXPECT_LE(digits_in(least), 150U) << as_points(least);
    EXPECT_GE(digits_in(query), 350U);
  }
  EXPECT_GE(missed, tests::trials(48) / 16);
}

// ---- Curves -------------------------------------------------------------------------------------

/// The least shape that fails is left, with the plainest query of it.
TEST(Shrink, LeavesThePlainestQueryOfTheLeastShape) {
  generate::Random random(1);
  std::vector<AnyQuery> originals = random_queries(1, 20);
  for (const std::size_t degree : {3U, 4U}) {
    originals.push_back(of_numbers({.degree = degree, .is_rational = true}, {}, random));
  }
  for (const AnyShape& shape : {AnyShape{},
                                {.degree = 2},
                                {.degree = 1, .is_rational = true},
                                {.degree = 3, .is_rational = true}}) {
    for (const AnyQuery& original : originals) {
      const auto is_at_least = [&](const AnyQuery& query) {
        return query.shape().degree >= shape.degree &&
               (query.shape().is_rational || !shape.is_rational);
      };
      if (!is_at_least(original)) continue;
      const AnyQuery least = shrink(original, is_at_least);
      EXPECT_EQ(least.shape().degree, shape.degree);
      EXPECT_EQ(least.shape().is_rational, shape.is_rational);
      expect_plain(least);
    }
  }
}

// ---- Properties of every run --------------------------------------------------------------------

/// A condition that depends on many coordinates: a hash of the rounded differences.
Predicate fickle(std::uint64_t seed) {
  return [seed](const AnyQuery& query) {
    double sum = static_cast<double>(seed % 7U);
    for (std::size_t i = 0; i < 23; ++i) {
      sum += std::abs(query.numbers()[i] - query.numbers()[i + 1]) > 0.25 ? 1.0 : 0.0;
    }
    return std::fmod(sum, 3.0) != 0.0 && sum > 6.0;
  };
}

TEST(Shrink, AsksOnlyPlainerQueriesAndNoneTwice) {
  std::vector<AnyQuery> queries = random_queries(5, tests::trials(16));
  generate::Random random(1);
  for (int i = 0; i < tests::trials(8); ++i) {
    queries.push_back(of_numbers({.degree = 3, .is_rational = i % 2 == 0}, {}, random));
  }
  for (const AnyQuery& query : queries) {
    const Predicate fails = fickle(query.numbers()[0] > 0 ? 1 : 2);
    AnyQuery best = query;
    const auto bits = [](const AnyQuery& some) {
      std::vector<std::uint64_t> result{some.shape().degree};
      for (const double x : some.numbers()) result.push_back(std::bit_cast<std::uint64_t>(x));
      return result;
    };
    std::set<std::vector<std::uint64_t>> asked{bits(query)};
    const AnyQuery least = shrink(query, [&](const AnyQuery& other) {
      EXPECT_LT(plainness(other), plainness(best));
      EXPECT_TRUE(asked.insert(bits(other)).second);
      if (fails(other)) best = other;
      return fails(other);
    });
    EXPECT_EQ(least, best);
  }
}

TEST(Shrink, KeepsItsLimits) {
  for (const AnyQuery& query : random_queries(7, 2)) {
    for (const std::uint64_t limit : {0U, 1U, 10U, 100U}) {
      std::uint64_t calls = 0;
      const auto count = [&](const AnyQuery&) {
        ++calls;
        return calls % 3 == 0;
      };
      const AnyQuery least = shrink(query, count, [&] { return calls >= limit; });
      EXPECT_LE(calls, limit);
      EXPECT_GE(calls, std::min<std::uint64_t>(limit, 10));
      EXPECT_EQ(least == query, limit < 3);
    }
    const auto never = [](const AnyQuery&) -> bool { throw std::logic_error("asked"); };
    EXPECT_THROW((void)shrink(query, never), std::logic_error);
  }
}

}  // namespace
}  // namespace touchstone::verify::fuzz::shrink_test

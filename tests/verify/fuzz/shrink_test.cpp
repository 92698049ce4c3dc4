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
#include <utility>
#include <vector>

#include "exact/oracle.hpp"
#include "fast/certified.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::verify::fuzz::shrink_test {
namespace {

using tests::PosedQuery;
using tests::Random;

using Predicate = std::function<bool(const Query&)>;

Query with_coordinates(const std::vector<std::pair<std::size_t, double>>& values) {
  Query query{};
  for (const auto& [place, value] : values) query.coordinates.at(place) = value;
  return query;
}

std::uint64_t length_of(const Query& query) { return complexity(Kind::vertex_face, query).length; }

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

// ---- The order ----------------------------------------------------------------------------------

TEST(Complexity, of_numbers_is_what_it_takes_to_write_them) {
  const auto alone = [](double x) { return length_of(with_coordinates({{5, x}})); };
  constexpr std::uint64_t rest = 8 + 2 + 1;  // a magnitude, not 0, moves
  EXPECT_EQ(length_of(Query{}), 0U);
  EXPECT_EQ(alone(1.0), rest + 1);
  EXPECT_EQ(alone(-1.0), rest + 2);
  EXPECT_EQ(alone(3.0), rest + 2);
  EXPECT_EQ(alone(4.0), rest + 3);
  EXPECT_EQ(alone(0.5), rest + 3);
  EXPECT_EQ(alone(0.125), rest + 5);
  EXPECT_EQ(alone(1.5), rest + 4);
  EXPECT_EQ(alone(0x1p1000), rest + 1001);
  EXPECT_EQ(alone(0x1p-1074), rest + 1 + 1073 + 2);
  EXPECT_EQ(alone(0x1.fffffffffffffp0), rest + 53 + 2);
  EXPECT_EQ(alone(-0.0), 1U);
}

TEST(Complexity, counts_a_magnitude_once_and_motion) {
  const std::uint64_t one = length_of(with_coordinates({{0, 5.0}}));
  EXPECT_EQ(length_of(with_coordinates({{0, 5.0}, {12, 5.0}})), one + 2 - 1);   // at rest
  EXPECT_EQ(length_of(with_coordinates({{0, 5.0}, {12, -5.0}})), one + 2 + 1);  // a sign
  EXPECT_EQ(length_of(with_coordinates({{0, 5.0}, {4, 5.0}})), one + 2 + 1);    // moves too
  EXPECT_GT(length_of(with_coordinates({{0, 5.0}, {12, 4.0}})), one + 8);
}

TEST(Complexity, prefers_the_less_of_equally_long_numbers) {
  const auto alone = [](double x) {
    return complexity(Kind::edge_edge, with_coordinates({{5, x}}));
  };
  EXPECT_EQ(alone(5.0).length, alone(7.0).length);
  EXPECT_LT(alone(5.0), alone(7.0));
}

TEST(Complexity, knows_which_points_may_be_exchanged) {
  const Query second = with_coordinates({{3, 1.0}}), third = with_coordinates({{6, 1.0}});
  const Query first = with_coordinates({{0, 1.0}}), fourth = with_coordinates({{9, 1.0}});
  EXPECT_LT(complexity(Kind::vertex_face, third), complexity(Kind::vertex_face, second));
  EXPECT_LT(complexity(Kind::vertex_face, fourth), complexity(Kind::vertex_face, third));
  EXPECT_EQ(complexity(Kind::vertex_face, first), complexity(Kind::vertex_face, fourth));
  EXPECT_LT(complexity(Kind::edge_edge, second), complexity(Kind::edge_edge, first));
  EXPECT_LT(complexity(Kind::edge_edge, fourth), complexity(Kind::edge_edge, third));
  EXPECT_EQ(complexity(Kind::edge_edge, second), complexity(Kind::edge_edge, fourth));
}

// ---- Known ends ---------------------------------------------------------------------------------

TEST(Shrink, leaves_nothing_where_everything_fails) {
  for (const auto& [kind, query] : random_queries(1, 20)) {
    EXPECT_EQ(shrink(kind, query, [](const Query&) { return true; }), Query{});
  }
}

TEST(Shrink, leaves_the_query_where_nothing_else_fails) {
  for (const auto& [kind, query] : random_queries(2, 20)) {
    EXPECT_EQ(shrink(kind, query, [](const Query&) { return false; }), query);
  }
}

TEST(Shrink, finds_the_least_number_that_a_condition_allows) {
  Query query{};
  query.coordinates.fill(4.1);
  const Query least =
      shrink(Kind::edge_edge, query, [](const Query& some) { return some.coordinates[5] > 3.7; });
  EXPECT_EQ(least, with_coordinates({{5, 4.0}}));
}

TEST(Shrink, finds_a_number_of_the_bits_that_a_condition_needs) {
  const auto is_inside = [](const Query& some) {
    return some.coordinates[20] > 1.0 && some.coordinates[20] < 1.01;
  };
  const Query start = with_coordinates({{3, 1e30}, {20, 1.00654321}, {7, -2.0 / 3.0}});
  const Query least = shrink(Kind::edge_edge, start, is_inside);
  EXPECT_EQ(least, with_coordinates({{20, 1.0 + 0x1p-7}}));
}

TEST(Shrink, keeps_one_difference_where_only_that_matters) {
  for (const auto& [kind, query] : random_queries(3, 20)) {
    const Query least =
        shrink(kind, query, [](const Query& some) { return some.at(0, 1, 0) != some.at(0, 2, 0); });
    // Points 1 and 2 are of one triangle or of two edges.
    const Query second = with_coordinates({{3, 1.0}}), third = with_coordinates({{6, 1.0}});
    EXPECT_TRUE(least == second || least == third) << PosedQuery{kind, least};
  }
}

TEST(Shrink, keeps_coordinates_equal_that_must_be) {
  Random random(4);
  Query query = tests::full_significand_query(random);
  query.at(0, 2, 1) = query.at(1, 3, 0) = query.at(0, 0, 2) = 0.7318;
  const Query least = shrink(Kind::vertex_face, query, [](const Query& some) {
    const double shared = some.at(0, 2, 1);
    return shared != 0.0 && some.at(1, 3, 0) == shared && some.at(0, 0, 2) == shared;
  });
  EXPECT_EQ(least, with_coordinates({{7, 1.0}, {21, 1.0}, {2, 1.0}}));
}

TEST(Shrink, orders_points_where_their_order_does_not_matter) {
  const auto has_1_2_4 = [](const Query& some) {
    std::array<double, 3> x{some.at(0, 1, 0), some.at(0, 2, 0), some.at(0, 3, 0)};
    std::ranges::sort(x);
    return x == std::array{1.0, 2.0, 4.0};
  };
  const Query sorted = with_coordinates({{3, 1.0}, {6, 2.0}, {9, 4.0}});
  EXPECT_EQ(shrink(Kind::vertex_face, sorted, has_1_2_4), sorted);
  const Query turned = with_coordinates({{3, 4.0}, {6, 1.0}, {9, 2.0}});
  EXPECT_EQ(shrink(Kind::vertex_face, turned, has_1_2_4), sorted);
}

TEST(Shrink, comes_back_from_the_ends_of_the_range) {
  for (const int exponent : {-1070, -1000, -500, 500, 960}) {
    Query query = tests::over_triangle(1, 1, 1, -2).query;
    for (double& x : query.coordinates) x = std::ldexp(x, exponent);
    const Query least = shrink(Kind::vertex_face, query, [](const Query& some) {
      return some.at(0, 0, 2) > 0.0 && some.at(1, 0, 2) < 0.0;
    });
    EXPECT_EQ(least, with_coordinates({{2, 1.0}, {14, -1.0}})) << exponent;
  }
}

// ---- Faults of methods --------------------------------------------------------------------------

/// The certified solver as if floats were enough.
bool is_missed_in_float(Kind kind, const Query& query) {
  Query rounded = query;
  for (double& x : rounded.coordinates) x = static_cast<double>(static_cast<float>(x));
  return fast::certified(kind, rounded).verdict == fast::Verdict::no &&
         exact::decide(kind, query).collides();
}

TEST(Shrink, makes_findings_of_a_method_short) {
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
    // Contact by a hair, which hardly any change of one coordinate leaves.
    EXPECT_LE(length_of(least), 600U) << PosedQuery{kind, least};
    EXPECT_GE(length_of(query), 1400U);
  }
  EXPECT_GE(missed, tests::trials(48) / 16);
}

TEST(Shrink, leaves_nothing_of_a_missed_start) {
  // A fault of all solvers that look for a sign to change: who touches from the beginning is missed.
  const auto is_missed = [](const Query& query) {
    const exact::Verdict truth = exact::decide(Kind::vertex_face, query);
    return truth.collides() && truth.toi->enclosure().upper == 0.0;
  };
  Query query = tests::over_triangle(1, 1, 0, -2).query;
  for (double& x : query.coordinates) x *= 0.7;
  ASSERT_TRUE(is_missed(query));
  EXPECT_EQ(shrink(Kind::vertex_face, query, is_missed), Query{});
}

TEST(Shrink, finds_small_integers_for_a_time_of_impact) {
  const auto is_late = [](const Query& query) {
    const exact::Verdict truth = exact::decide(Kind::vertex_face, query);
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
    EXPECT_LE(length_of(least), 45U) << PosedQuery{Kind::vertex_face, least};
  }
}

// ---- What holds of every run --------------------------------------------------------------------

/// Some condition that depends on many coordinates: a hash of the rounded differences.
Predicate fickle(std::uint64_t seed) {
  return [seed](const Query& query) {
    double sum = static_cast<double>(seed % 7U);
    for (std::size_t i = 0; i < 23; ++i) {
      sum += std::abs(query.coordinates[i] - query.coordinates[i + 1]) > 0.25 ? 1.0 : 0.0;
    }
    return std::fmod(sum, 3.0) != 0.0 && sum > 6.0;
  };
}

TEST(Shrink, asks_only_simpler_queries_and_none_twice) {
  for (const auto& [kind, query] : random_queries(5, tests::trials(16))) {
    const Predicate fails = fickle(query.coordinates[0] > 0 ? 1 : 2);
    Query best = query;
    using Bits = std::array<std::uint64_t, 24>;
    std::set<Bits> asked{std::bit_cast<Bits>(query)};
    const Query least = shrink(kind, query, [&, kind = kind](const Query& other) {
      EXPECT_LT(complexity(kind, other), complexity(kind, best));
      EXPECT_TRUE(asked.insert(std::bit_cast<Bits>(other)).second);
      if (fails(other)) best = other;
      return fails(other);
    });
    EXPECT_EQ(least, best);
  }
}

TEST(Shrink, ends_where_it_would_end_from_there) {
  for (const auto& [kind, query] : random_queries(6, tests::trials(16))) {
    const Predicate fails = fickle(query.coordinates[1] > 0 ? 1 : 2);
    const Query least = shrink(kind, query, fails);
    EXPECT_EQ(shrink(kind, least, fails), least);
    EXPECT_EQ(shrink(kind, query, fails), least);
  }
}

TEST(Shrink, keeps_its_limits) {
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

TEST(Shrink, ends_between_two_calls_when_it_must) {
  for (const auto& [kind, query] : random_queries(8, 2)) {
    std::uint64_t calls = 0;
    const auto count = [&](const Query&) { return ++calls % 3 == 0; };
    const Query least = shrink(kind, query, count, {.must_end = [&] { return calls >= 10; }});
    EXPECT_EQ(calls, 10U);
    EXPECT_NE(least, query);
  }
}

}  // namespace
}  // namespace touchstone::verify::fuzz::shrink_test

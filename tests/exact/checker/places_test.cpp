#include "exact/checker/places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/random.hpp"

// What the checker does in integers is held against the same in rational numbers: it never sees a
// direction where there is none, nor leaves out a pair, and is at most a rounding too careful.

namespace touchstone::checker::places_test {
namespace {

using tests::Random;
using Pairs = std::set<std::pair<std::int32_t, std::int32_t>>;

mpq_class place(const Motion& x, std::size_t axis, const mpq_class& t) {
  return x.start.at(axis) + t * (mpq_class(x.end.at(axis)) - x.start.at(axis));
}

/// By how much d keeps a above b, less the distance.
mpq_class gap(const std::vector<Motion>& vertices, double distance, const mpq_class& end,
              const Primitive& a, const Primitive& b, const Direction& d) {
  mpq_class least = 1;
  bool is_first = true;
  for (const mpq_class& t : {mpq_class(0), end}) {
    for (const std::int32_t v : a.vertices) {
      for (const std::int32_t w : b.vertices) {
        mpq_class value = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const mpq_class difference =
              place(vertices[std::size_t(v)], axis, t) - place(vertices[std::size_t(w)], axis, t);
          value += mpq_class(long(d[axis])) * difference -
                   mpq_class(distance) * mpq_class(long(std::abs(d[axis])));
        }
        if (is_first || value < least) least = value;
        is_first = false;
      }
    }
  }
  return least;
}

std::vector<Motion> random_vertices(Random& random, std::size_t count, double size) {
  std::vector<Motion> vertices(count);
  const auto coordinate = [&] {
    return random.coin() ? size * random.between(-4, 4) : random.uniform(-size, size);
  };
  for (Motion& x : vertices) {
    for (double& c : x.start) c = coordinate();
    for (double& c : x.end) c = coordinate();
  }
  return vertices;
}

Primitives random_primitives(Random& random, int count, int vertices) {
  Primitives primitives;
  const auto vertex = [&] { return random.between(0, vertices - 1); };
  for (int i = 0; i < count; ++i) primitives.push_back({3 * i, {vertex(), vertex(), vertex()}});
  return primitives;
}

TEST(Places, SeesADirectionOnlyWhereItSeparates) {
  Random random(1);
  int seen = 0, close = 0;
  for (int trial = 0; trial < 4'000; ++trial) {
    const double size = std::ldexp(1.0, random.between(-1060, 1020));
    const std::vector<Motion> vertices = random_vertices(random, 6, size);
    const double distance = random.coin() ? 0.0 : 0.125 * size;
    const mpq_class end = random.coin() ? mpq_class(1) : mpq_class(random.uniform(0, 1));
    const Places places(vertices, distance, end);
    const Primitive a{0, {0, 1, 2}}, b{0, {3, 4, 5}};
    Direction d{};
    for (auto& x : d) x = random.between(-1023, 1023);
    const mpq_class exact = gap(vertices, distance, end, a, b, d);
    const bool is_above = places.is_above(a, b, d, places.enlarged(distance));
    EXPECT_TRUE(!is_above || exact > 0);
    // Each of nine products is off by at most 1023 units of 2^-50 of the greatest coordinate.
    mpq_class rounding(size);
    rounding *= 4 * 9 * 1024;
    rounding >>= 48;
    EXPECT_TRUE(is_above || exact <= rounding);
    seen += is_above ? 1 : 0;
    close += exact > 0 && !is_above ? 1 : 0;
  }
  EXPECT_GT(seen, 20);
  EXPECT_LT(close, 40);
}

TEST(Places, FindsEveryPairThatNoAxisKeepsApart) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const std::vector<Motion> vertices = random_vertices(random, 12, 1.0);
    const double distance = 0.25 * random.between(0, 1);
    const mpq_class end = random.coin() ? mpq_class(1) : mpq_class(1, 3);
    const Places places(vertices, distance, end);
    const Primitives some = random_primitives(random, 7, 12);
    const Primitives others = random_primitives(random, 9, 12);
    const bool is_same = random.coin();
    Pairs expected;
    for (const Primitive& a : some) {
      for (const Primitive& b : is_same ? some : others) {
        if (is_same && b.number <= a.number) continue;
        if (!places.is_axis_between(a, b, places.enlarged(distance))) {
          expected.emplace(a.number, b.number);
        }
      }
    }
    Pairs found;
    // No more than the pairs of all nodes.
    std::int64_t comparisons_left = 17 * 17;
    places.find_near(some, is_same ? some : others, comparisons_left,
                     [&](const Primitive& a, const Primitive& b) {
                       EXPECT_TRUE(found.emplace(a.number, b.number).second);
                     });
    EXPECT_EQ(found, expected);
  }
}

// However the points of a scene lie, those that are apart cost no more than some comparisons each.
TEST(Places, ComparesNotAllWithAllWherePointsShareACoordinate) {
  Random random(4);
  constexpr std::int32_t count = 20'000;
  for (const unsigned shared : {0U, 1U, 2U, 3U, 4U, 5U, 6U}) {
    std::vector<Motion> vertices(count);
    Primitives points;
    for (std::int32_t i = 0; i < count; ++i) {
      Motion& x = vertices[std::size_t(i)];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_shared = ((shared >> axis) & 1U) != 0;
        x.start.at(axis) = is_shared ? 1.0 : random.uniform(-1, 1);
        x.end.at(axis) = x.start.at(axis);
      }
      points.push_back({i, {i, i, i}});
    }
    std::int64_t comparisons_left = std::int64_t{200} * count;
    int met = 0;
    Places(vertices, 0.0, 1)
        .find_near(points, points, comparisons_left,
                   [&](const Primitive&, const Primitive&) { ++met; });
    EXPECT_EQ(met, 0) << shared;
  }
}

}  // namespace
}  // namespace touchstone::checker::places_test

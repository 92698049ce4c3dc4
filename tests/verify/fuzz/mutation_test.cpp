#include "verify/fuzz/mutation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "touchstone/query.hpp"
#include "verify/generate/random.hpp"

namespace touchstone::verify::fuzz::mutation_test {
namespace {

using generate::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest = std::numeric_limits<double>::max();
constexpr double least = std::numeric_limits<double>::denorm_min();

TEST(Stepped, GoesFromDoubleToDouble) {
  EXPECT_EQ(stepped(1.0, 1), std::nextafter(1.0, infinity));
  EXPECT_EQ(stepped(1.0, -1), std::nextafter(1.0, -infinity));
  EXPECT_EQ(stepped(-1.0, 1), std::nextafter(-1.0, infinity));
  EXPECT_EQ(stepped(0.0, 1), least);
  EXPECT_EQ(stepped(-0.0, -1), -least);
  EXPECT_EQ(stepped(least, -2), -least);
  EXPECT_EQ(stepped(1.0, std::int64_t{1} << 52), 2.0);
  EXPECT_EQ(stepped(greatest, 5), greatest);
  EXPECT_EQ(stepped(-greatest, -5), -greatest);
}

int differences(const Query& a, const Query& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.coordinates.size(); ++i) {
    count += a.coordinates.at(i) != b.coordinates.at(i) ? 1 : 0;
  }
  return count;
}

TEST(Nudge, MovesUpToThreeCoordinatesByLittle) {
  Random random(1);
  int changed = 0;
  for (int i = 0; i < 1000; ++i) {
    Query query{};
    query.coordinates.fill(3.0);
    Query nudged = query;
    nudge(nudged, random);
    EXPECT_LE(differences(query, nudged), 3);
    changed += differences(query, nudged) > 0 ? 1 : 0;
    for (const double x : nudged.coordinates) EXPECT_LT(std::abs(x - 3.0), 0x1p-9);
  }
  EXPECT_GT(changed, 950);
}

TEST(Mutated, StaysFiniteWhereverItStarts) {
  Random random(2);
  for (const double start : {0.0, least, -1.5, greatest, -greatest}) {
    Query query{};
    query.coordinates.fill(start);
    for (int i = 0; i < 5000; ++i) {
      query = mutated(query, random);
      ASSERT_TRUE(is_finite(query));
    }
  }
}

TEST(Mutated, DoesAllThatItSays) {
  Query query{};
  for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
    query.coordinates.at(i) = 1.0 + 0.1 * static_cast<double>(i);
  }
  Random random(3);
  int zero = 0, negated = 0, at_rest = 0, doubled = 0, copied = 0, unchanged = 0;
  for (int i = 0; i < 3000; ++i) {
    const Query result = mutated(query, random);
    unchanged += result == query ? 1 : 0;
    at_rest += result.point(0, 1) == result.point(1, 1) ? 1 : 0;
    for (std::size_t j = 0; j < query.coordinates.size(); ++j) {
      const double x = result.coordinates.at(j);
      zero += x == 0.0 ? 1 : 0;
      negated += x == -query.coordinates.at(j) ? 1 : 0;
      doubled += x == 2.0 * query.coordinates.at(j) ? 1 : 0;
      copied += j != 0 && x == query.coordinates.at(j % 3) && j >= 3 ? 1 : 0;
    }
  }
  for (const int count : {zero, negated, at_rest, doubled, copied}) EXPECT_GT(count, 10);
  EXPECT_LT(unchanged, 600);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::mutation_test

#include "verify/fuzz/mutation.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace touchstone::verify::fuzz::mutation_test

#include "verify/fuzz/mutation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/fuzz/curves.hpp"
#include "verify/fuzz/plainness.hpp"
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
    for (const QueryShape& shape : {QueryShape{}, {.degree = 3}, {.is_rational = true}}) {
      base::AnyQuery query(shape, std::vector<double>(shape.numbers_of_query(), start));
      for (std::size_t i = 3; shape.is_rational && i < query.numbers().size(); i += 4) {
        query.numbers()[i] = 0x1p39;
      }
      for (int i = 0; i < 5000; ++i) {
        query = mutated(query, true, random);
        ASSERT_TRUE(is_valid(query));
      }
    }
  }
}

TEST(Mutated, LeavesWeightsAloneIfAsked) {
  Random random(3);
  const QueryShape shape{.degree = 2, .is_rational = true};
  const base::AnyQuery query = of_numbers(shape, {}, random);
  bool is_changed = false;
  for (int i = 0; i < 500; ++i) {
    const base::AnyQuery kept = mutated(query, false, random);
    const base::AnyQuery free = mutated(query, true, random);
    for (std::size_t place = 3; place < query.numbers().size(); place += 4) {
      ASSERT_EQ(kept.numbers()[place], query.numbers()[place]);
      is_changed = is_changed || free.numbers()[place] != query.numbers()[place];
    }
  }
  EXPECT_TRUE(is_changed);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::mutation_test

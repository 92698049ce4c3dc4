#include "touchstone/derivation/bound_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace touchstone::filters::bound_table_test {
namespace {

// What a table says, and its missing columns, are in tests/transcripts/derive.md.

DeriveOptions quick() {
  DeriveOptions options;
  options.models = {Model::observed};
  options.search.evaluations = 2'000;
  return options;
}

TEST(BoundTable, GivesTheSameInAnyNumberOfThreads) {
  DeriveOptions one = quick(), many = one;
  one.threads = 1;
  many.threads = 5;
  const DeriveResult a = derive(one), b = derive(many);
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].observed->units, b.rows.at(i).observed->units);
  }
}

TEST(BoundTable, ReportsProgressAndStops) {
  DeriveOptions options = quick();
  options.threads = 1;
  std::vector<double> fractions;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  static_cast<void>(derive(options));
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(fractions.size(), 41U);
  EXPECT_EQ(fractions.back(), 1.0);
  options.stop = [] { return true; };
  const DeriveResult stopped = derive(options);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_FALSE(stopped.rows.front().observed);
}

}  // namespace
}  // namespace touchstone::filters::bound_table_test

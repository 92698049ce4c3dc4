#include "verify/report/changes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::changes_test {
namespace {

using Row = std::vector<std::string>;

TEST(Changes, AreCountsTimesAndMethods) {
  const Measurements before = tests::small_report();
  Measurements after = before;
  after.all[1].false_positives = 3;
  after.all[1].nanoseconds *= 0.5;
  after.all[2].method = "mine";
  const Table table = changes_between(before, after);
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0], (Row{"tight_inclusion", "=", "8 of 100 → 3 of 100", "=", "250 → 125",
                                "handcrafted, vertex-face"}));
  EXPECT_EQ(table.rows[1][0], "mine");
  EXPECT_EQ(table.rows[1][1], "new");
  EXPECT_EQ(table.rows[2][0], "msrf");
  EXPECT_EQ(table.rows[2][1], "gone");
}

TEST(Changes, OfATimeCountBeyondItsNoise) {
  const Measurements before = tests::small_report();
  Measurements after = before;
  after.all[1].nanoseconds *= 1.2;
  EXPECT_TRUE(changes_between(before, after).rows.empty());
  after.all[1].nanoseconds *= 1.2;
  EXPECT_EQ(changes_between(before, after).rows.size(), 1U);
}

TEST(Changes, SayThatQueriesAreOthers) {
  Measurements before = tests::small_report();
  before.groups = {{.name = "handcrafted", .kind = Kind::vertex_face, .queries = 200, .digest = 1}};
  Measurements after = before;
  after.groups[0].digest = 2;
  after.all[2].false_negatives = 5;
  const Table table = changes_between(before, after);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0][1], "2 of 100 → 5 of 100");
  EXPECT_EQ(table.rows[0][5], "handcrafted, vertex-face (other queries)");
}

}  // namespace
}  // namespace touchstone::verify::report::changes_test

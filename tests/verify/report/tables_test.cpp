#include "verify/report/tables.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/support/measurements.hpp"

namespace touchstone::verify::report::tables_test {
namespace {

using Row = std::vector<std::string>;

TEST(Tables, TheFieldsHasThePublishedNumbersBesideOurs) {
  const std::vector<Table> tables = field_tables(tests::small_report());
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables[0].title, "handcrafted, vertex-face");
  EXPECT_EQ(tables[0].columns, (Row{"method", "FN", "FP", "µs", "÷ certified", "late", "asked",
                                    "collide", "at limit", "toi error, median", "toi error, max",
                                    "published (12K) µs", "published FP", "published FN"}));
  ASSERT_EQ(tables[0].rows.size(), 3U);
  EXPECT_EQ(tables[0].rows[0], (Row{"certified", "0", "0", "0.01", "1", "0", "100 of 200", "20",
                                    "0", "0", "1e-13", "–", "–", "–"}));
  EXPECT_EQ(tables[0].rows[1],
            (Row{"tight_inclusion", "0", "8 (10 %)", "2.5", "250", "0", "100 of 200", "20", "0",
                 "1e-07", "0.5", "1532.54", "108", "0"}));
  EXPECT_EQ(tables[0].rows[2], (Row{"msrf", "2", "1 (1.2 %)", "0.4", "40", "0", "100 of 200", "20",
                                    "0", "–", "–", "12.90", "16", "386"}));
}

TEST(Tables, MarkAMethodThatWasAskedFewerQueries) {
  Measurements measurements = tests::small_report();
  measurements.all[1].asked = 50;
  const Table table = field_tables(measurements).at(0);
  EXPECT_EQ(table.rows[0][0], "certified");
  EXPECT_EQ(table.rows[1][0], "tight_inclusion*");
  EXPECT_EQ(table.rows[1][11], "1532.54");
}

TEST(Tables, OtherDataHaveNoPublishedColumns) {
  Measurements measurements;
  measurements.all = {tests::measured("patches", "msrf", 1000.0)};
  measurements.all[0].asked = 200;
  const std::vector<Table> tables = field_tables(measurements);
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables[0].columns.size(), 11U);
  EXPECT_EQ(tables[0].rows[0],
            (Row{"msrf", "0", "0", "1", "100", "0", "200", "20", "0", "–", "–"}));
}

TEST(Tables, GroupsAndKindsHaveTablesOfTheirOwn) {
  Measurements measurements;
  measurements.all = {tests::measured("a", "msrf", 1.0), tests::measured("b", "msrf", 1.0),
                      tests::measured("a", "msrf", 1.0)};
  measurements.all[2].kind = Kind::edge_edge;
  const std::vector<Table> tables = field_tables(measurements);
  ASSERT_EQ(tables.size(), 3U);
  EXPECT_EQ(tables[2].title, "a, edge-edge");
}

TEST(Tables, SeparationsPutAMethodBesideOurs) {
  const std::vector<Table> tables = separation_tables(tests::small_report(), "msrf");
  ASSERT_EQ(tables.size(), 1U);
  ASSERT_EQ(tables[0].rows.size(), 3U);
  EXPECT_EQ(tables[0].rows[0], (Row{"1e-08", "msrf", "L2", "0", "0", "0.03", "3", "0", "100 of 200",
                                    "20", "0", "15.05", "216", "2"}));
  EXPECT_EQ(tables[0].rows[1][1], "tight_inclusion");
  EXPECT_EQ(tables[0].rows[1][11], "1.60K");
  EXPECT_EQ(tables[0].rows[2][1], "certified");
  EXPECT_EQ(tables[0].rows[2][2], "L∞");
  EXPECT_TRUE(separation_tables(tests::small_report(), "fprf").empty());
  EXPECT_EQ(separation_tables(tests::small_report(), "tight_inclusion").at(0).rows.size(), 2U);
}

TEST(Tables, OfFiltersHaveAColumnAMethodAndFamiliesOnlyWhereSomethingIsMissed) {
  Measurements measurements = tests::small_report();
  Measurement calm = tests::measured("calm-family", "tight_inclusion", Measurement::unknown);
  calm.experiment = Experiment::filter;
  measurements.all.push_back(calm);
  const std::vector<Table> tables = filter_tables(measurements);
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[0].title, "contact at t=1, two decimals");
  using Texts = std::vector<std::string>;
  EXPECT_EQ(tables[0].columns, (Texts{"scale", "kind", "collide", "tight_inclusion FN",
                                      "tight_inclusion_released FN"}));
  ASSERT_EQ(tables[0].rows.size(), 1U);
  EXPECT_EQ(tables[0].rows[0], (Texts{"0.01", "vertex-face", "20", "0", "2 (10 %)"}));
  ASSERT_EQ(tables[1].rows.size(), 1U);
  EXPECT_EQ(tables[1].rows[0][0], "a-family");
  EXPECT_TRUE(filter_tables({}).empty());
}

TEST(Tables, NumbersAreShort) {
  EXPECT_EQ(short_number(0.0), "0");
  EXPECT_EQ(short_number(0.0123456), "0.0123");
  EXPECT_EQ(short_number(12.345), "12.3");
  EXPECT_EQ(short_number(124242.4), "124242");
  EXPECT_EQ(short_number(1e-100), "1e-100");
  EXPECT_EQ(short_number(std::numeric_limits<double>::quiet_NaN()), "–");
}

TEST(Tables, HavePercentOfTwoDigits) {
  EXPECT_EQ(percent(0.0000123), "0.0012 %");
  EXPECT_EQ(percent(0.083), "8.3 %");
  EXPECT_EQ(percent(0.994), "99 %");
  EXPECT_EQ(percent(0.996), "100 %");
  EXPECT_EQ(percent(1.0), "100 %");
}

TEST(Tables, WriteMarkdownAndCsv) {
  const Table table{.title = "t", .columns = {"a", "b|c"}, .rows = {{"1", "x, \"y\""}}};
  EXPECT_EQ(to_markdown(table), "| a | b\\|c |\n| --- | --- |\n| 1 | x, \"y\" |\n");
  const Table hostile{.title = "t", .columns = {"a"}, .rows = {{"=1+1\n| x | **y** <b> \u202e"}}};
  EXPECT_EQ(
      to_markdown(hostile),
      "| a |\n| --- |\n| =1+1\\\\x0a\\| x \\| \\*\\*y\\*\\* \\<b\\> \\\\xe2\\\\x80\\\\xae |\n");
  EXPECT_EQ(to_csv(hostile), "a\r\n'=1+1\\x0a| x | **y** <b> \\xe2\\x80\\xae\r\n");
  EXPECT_EQ(to_csv(table), "a,b|c\r\n1,\"x, \"\"y\"\"\"\r\n");
}

}  // namespace
}  // namespace touchstone::verify::report::tables_test

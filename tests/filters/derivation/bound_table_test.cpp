#include "touchstone/derivation/bound_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "touchstone/derivation/catalogue.hpp"

namespace touchstone::filters::bound_table_test {
namespace {

DeriveOptions quick(std::set<Model> models) {
  DeriveOptions options;
  options.models = std::move(models);
  options.search.evaluations = 2'000;
  return options;
}

/// Rows of the catalogue in one of the formats.
std::size_t rows_in(const std::vector<Format>& formats) {
  std::size_t rows = 0;
  for (const CatalogueEntry& entry : catalogue()) {
    for (const Format& format : formats) {
      rows += static_cast<std::size_t>(
          std::ranges::count(entry.formats, format.digits, &Format::digits));
    }
  }
  return rows;
}

TEST(BoundTable, HasARowForEachExpressionAndPrecision) {
  const DeriveResult result = derive(quick({Model::published, Model::rigorous, Model::observed}));
  ASSERT_EQ(result.rows.size(), rows_in({double_format, float_format, double_double_format}));
  EXPECT_EQ(result.rows.size(), 41U);
  EXPECT_FALSE(result.gappa_missing);
  EXPECT_FALSE(result.stopped);
  const DeriveRow& row = result.rows.at(1);
  EXPECT_EQ(row.expression, "edge_edge");
  EXPECT_STREQ(row.format.name, "float");
  EXPECT_EQ(row.published_constant, "3.337861e-06");
  EXPECT_EQ(row.published, mpq_class(56)) << "the paper's model on the paper's order";
  EXPECT_NEAR(row.rigorous.value().get_d(), 10, 1e-5);
  EXPECT_FALSE(row.gappa);
  EXPECT_GT(row.observed.value().units, 1);
  EXPECT_EQ(row.tightness(), row.rigorous->get_d() / row.observed->units);
}

TEST(BoundTable, HasRowsOfPairsInTheirOwnUnits) {
  DeriveOptions options = quick({Model::published, Model::rigorous, Model::observed});
  options.formats = {double_double_format};
  const DeriveResult result = derive(options);
  ASSERT_EQ(result.rows.size(), 4U);
  const DeriveRow& row = result.rows.front();
  EXPECT_EQ(row.expression, "determinant_end");
  EXPECT_STREQ(row.format.name, "double_double");
  EXPECT_FALSE(row.published);
  EXPECT_NEAR(row.rigorous.value().get_d(), 64, 1e-5);
  EXPECT_GT(row.observed.value().units, 0.1);
  EXPECT_LT(row.observed->units, 64);
}

TEST(BoundTable, LeavesOutWhatIsNotAskedFor) {
  DeriveOptions options = quick({Model::rigorous});
  options.formats = {double_format};
  const DeriveResult result = derive(options);
  ASSERT_EQ(result.rows.size(), rows_in({double_format}));
  for (const DeriveRow& row : result.rows) {
    EXPECT_FALSE(row.published || row.gappa || row.observed || row.tightness());
    EXPECT_TRUE(row.rigorous);
  }
}

TEST(BoundTable, GivesTheSameInAnyNumberOfThreads) {
  DeriveOptions one = quick({Model::observed}), many = one;
  one.threads = 1;
  many.threads = 5;
  const DeriveResult a = derive(one), b = derive(many);
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].observed->units, b.rows.at(i).observed->units);
  }
}

TEST(BoundTable, ReportsProgressAndStops) {
  DeriveOptions options = quick({Model::observed});
  options.threads = 1;
  std::vector<double> fractions;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  static_cast<void>(derive(options));
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(fractions.size(), rows_in(options.formats));
  EXPECT_EQ(fractions.back(), 1.0);
  options.stop = [] { return true; };
  const DeriveResult stopped = derive(options);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_FALSE(stopped.rows.front().observed);
}

TEST(BoundTable, MissingGappaLeavesItsColumnEmpty) {
  const char* const path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  setenv("PATH", "/nonexistent", 1);
  const DeriveResult result = derive(quick({Model::rigorous, Model::gappa}));
  setenv("PATH", before.c_str(), 1);
  EXPECT_TRUE(result.gappa_missing);
  EXPECT_FALSE(result.rows.front().gappa);
  EXPECT_TRUE(result.rows.front().rigorous);
}

TEST(BoundTable, PrintsALineARow) {
  DeriveOptions options = quick({Model::published, Model::rigorous});
  options.formats = {double_format};
  const std::string table = to_table(derive(options));
  EXPECT_EQ(std::ranges::count(table, '\n'), static_cast<long>(rows_in(options.formats)) + 1);
  EXPECT_TRUE(table.starts_with("expression ")) << table;
  EXPECT_NE(table.find("6.217248937900877e-15       56 u       10 u"), std::string::npos) << table;
}

}  // namespace
}  // namespace touchstone::filters::bound_table_test

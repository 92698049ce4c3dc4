#include "touchstone/derivation/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/filters/support.hpp"

namespace touchstone::filters::catalogue_test {
namespace {

TEST(Catalogue, HoldsEachExpressionOnce) {
  std::set<std::string> names;
  for (const CatalogueEntry& entry : catalogue()) {
    EXPECT_TRUE(names.insert(entry.graph.name).second) << entry.graph.name;
  }
  EXPECT_EQ(names.size(), 26U);
}

TEST(Catalogue, NamesOrdersThatItHolds) {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.published) {
      EXPECT_EQ(find_expression(entry.published->order).graph.name, entry.published->order);
    }
  }
  EXPECT_THROW(static_cast<void>(find_expression("nonsense")), std::invalid_argument);
}

TEST(Catalogue, EvaluatesWhatItRecorded) {
  std::mt19937_64 random(1);
  const Inputs inputs{{1, -2, 3, 5, 8, -13, 21, 34}, random_weights<EdgeEdge>(random, 10)};
  const CatalogueEntry& entry = find_expression("edge_edge");
  EXPECT_EQ(entry.evaluators.in_double(inputs), (computed_value<EdgeEdge, double>(inputs)));
  EXPECT_EQ(entry.evaluators.in_float(inputs),
            static_cast<double>(computed_value<EdgeEdge, float>(inputs)));
  EXPECT_EQ(entry.evaluators.in_mpfr(inputs, 200).to_double(),
            exact_value<EdgeEdge>(inputs).get_d());
  const auto [high, low] = entry.evaluators.in_double_double(inputs);
  EXPECT_EQ(mpq_class(high) + mpq_class(low), exact_value<EdgeEdge>(inputs)) << "of few bits";
}

TEST(Catalogue, ShipsTheBoundsOfTheSolversAndNoOthers) {
  const std::string header = error_bounds_header();
  for (const CatalogueEntry& entry : catalogue()) {
    ASSERT_FALSE(entry.formats.empty());
    for (const Format& format : {double_format, float_format, double_double_format}) {
      const bool runs =
          std::ranges::find(entry.formats, format.digits, &Format::digits) != entry.formats.end();
      const std::string name = " " + entry.graph.name + "_" + format.name + "{";
      EXPECT_EQ(header.find(name) != std::string::npos, entry.ships && runs) << name;
    }
  }
}

TEST(Catalogue, ShipsBoundsThatAreNumbersThatCodeComparesWith) {
  const std::string header = error_bounds_header();
  for (const char* declaration : {"ErrorBound<float, 1> edge_edge_float{",
                                  "ErrorBound<double, 2> measured_projected_gap_double{",
                                  "ErrorBound<double, 3> determinant_end_double_double{"}) {
    EXPECT_NE(header.find(declaration), std::string::npos) << declaration;
  }
}

}  // namespace
}  // namespace touchstone::filters::catalogue_test

#include "filters/derivation/catalogue.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "tests/filters/support.hpp"

namespace touchstone::filters {
namespace {

TEST(Catalogue, HoldsEachExpressionOnce) {
  std::set<std::string> names;
  for (const CatalogueEntry& entry : catalogue()) {
    EXPECT_TRUE(names.insert(entry.graph.name).second) << entry.graph.name;
  }
  EXPECT_EQ(names.size(), 8U);
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
}

TEST(Catalogue, ShipsTheBoundsOfTheSolversAndNoOthers) {
  const std::string header = error_bounds_header();
  for (const CatalogueEntry& entry : catalogue()) {
    for (const char* format : {"double", "float"}) {
      const std::string name = " " + entry.graph.name + "_" + format + "{";
      EXPECT_EQ(header.find(name) != std::string::npos, entry.ships) << name;
    }
  }
}

}  // namespace
}  // namespace touchstone::filters

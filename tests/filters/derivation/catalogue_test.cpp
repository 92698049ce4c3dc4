#include "touchstone/derivation/catalogue.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace touchstone::filters::catalogue_test

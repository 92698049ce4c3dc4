#include "touchstone/filters/expressions.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/filters/support.hpp"
#include "tests/support/contact_function.hpp"
#include "touchstone/query.hpp"

namespace touchstone::filters::expressions_test {
namespace {

/// A query with these coordinates on axis 0.
Query query_of(const std::vector<double>& x) {
  Query query{};
  for (std::size_t i = 0; i < 8; ++i) query.at(i / 4, i % 4, 0) = x[i];
  return query;
}

Inputs random_inputs(std::mt19937_64& random, std::size_t coordinates) {
  Inputs inputs;
  for (std::size_t i = 0; i < coordinates; ++i) {
    const auto bits = static_cast<std::int64_t>(random() >> 11U) - (std::int64_t{1} << 52U);
    inputs.coordinates.push_back(std::ldexp(static_cast<double>(bits), -52));
  }
  return inputs;
}

template <class Expression>
class EveryExpression : public ::testing::Test {};
using Expressions =
    ::testing::Types<EdgeEdge, VertexFace, EdgeEdgeSeparated, VertexFaceSeparated, PaperEdgeEdge,
                     PaperVertexFace, PaperEdgeEdgeSeparated, PaperVertexFaceSeparated>;
TYPED_TEST_SUITE(EveryExpression, Expressions);

template <class Expression>
constexpr Kind kind_of =
    Expression::weights == EdgeEdge::weights ? Kind::edge_edge : Kind::vertex_face;

TYPED_TEST(EveryExpression, IsTheContactFunctionInRationals) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    Inputs inputs = random_inputs(random, TypeParam::coordinates);
    inputs.weights = random_weights<TypeParam>(random, 20);
    const bool edges = kind_of<TypeParam> == Kind::edge_edge;
    const mpq_class t(inputs.weights[1]), u(inputs.weights[3]), v(inputs.weights[edges ? 5 : 4]);
    mpq_class truth =
        tests::contact_function(kind_of<TypeParam>, query_of(inputs.coordinates), t, u, v).at(0);
    if (TypeParam::coordinates == 9) truth -= mpq_class(inputs.coordinates[8]);
    EXPECT_EQ(exact_value<TypeParam>(inputs), truth);
  }
}

TYPED_TEST(EveryExpression, HasGroupsWhoseWeightsAddUpToOne) {
  TypeParam::visit_groups([](const auto& group) {
    for (const auto& vertex : group) {
      int sum = 0;
      for (const int weight : vertex) sum += weight;
      EXPECT_EQ(sum, 1);
    }
  });
}

TEST(Expressions, AreExactAtTheEndsOfMotionAndEdges) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 100; ++i) {
    Inputs inputs = random_inputs(random, 8);
    const std::vector<double>& x = inputs.coordinates;
    inputs.weights = {1, 0, 1, 0, 1, 0};
    EXPECT_EQ((computed_value<EdgeEdge, double>(inputs)), x[0] - x[2]);
    inputs.weights = {0, 1, 0, 1, 0, 1};
    EXPECT_EQ((computed_value<EdgeEdge, double>(inputs)), x[5] - x[7]);
    inputs.weights = {0, 1, 0, 0, 1};
    EXPECT_EQ((computed_value<VertexFace, double>(inputs)), x[4] - x[7]);
  }
}

TEST(Expressions, CanRunAtCompileTime) {
  static_assert(EdgeEdge::evaluate<double>({1, 2, 3, 4, 5, 6, 7, 8}, {.5, .5, .5, .5, .5, .5}) ==
                -2.0);
  static_assert(VertexFaceSeparated::evaluate<double>({1, 2, 2, 2, 1, 2, 2, 2, 0.25},
                                                      {.5, .5, -1, 1, 1}) == -1.25);
}

}  // namespace
}  // namespace touchstone::filters::expressions_test

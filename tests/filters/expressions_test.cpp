#include "filters/expressions.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "exact/query.hpp"
#include "tests/filters/support.hpp"

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
        contact_function(kind_of<TypeParam>, query_of(inputs.coordinates), t, u, v).at(0);
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

using DoubleLanes [[gnu::vector_size(16)]] = double;
using FloatLanes [[gnu::vector_size(16)]] = float;

/// Evaluates an expression on lanes; each must equal the scalar's value, bit by bit.
template <class Expression, class Lanes, class Scalar>
void expect_lanes_equal_scalars(std::mt19937_64& random) {
  constexpr std::size_t lanes = sizeof(Lanes) / sizeof(Scalar);
  std::array<Inputs, lanes> inputs;
  std::array<Lanes, Expression::coordinates> x{};
  std::array<Lanes, Expression::weights> w{};
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    inputs[lane] = random_inputs(random, Expression::coordinates);
    inputs[lane].weights = random_weights<Expression>(random, 20);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i][lane] = static_cast<Scalar>(inputs[lane].coordinates[i]);
    }
    for (std::size_t i = 0; i < w.size(); ++i) {
      w[i][lane] = static_cast<Scalar>(inputs[lane].weights[i]);
    }
  }
  const Lanes result = Expression::evaluate(x, w);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    EXPECT_EQ(result[lane], (computed_value<Expression, Scalar>(inputs[lane])));
  }
}

TYPED_TEST(EveryExpression, RunsInVectorsLikeInScalars) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    expect_lanes_equal_scalars<TypeParam, DoubleLanes, double>(random);
    expect_lanes_equal_scalars<TypeParam, FloatLanes, float>(random);
  }
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

/// \file
/// The values of expressions in rational numbers are those of what they stand for.

#include "touchstone/filters/expressions.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "tests/filters/support.hpp"
#include "tests/support/contact_function.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/filters/separation_expressions.hpp"
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
constexpr ContactKind kind_of =
    Expression::weights == EdgeEdge::weights ? ContactKind::edge_edge : ContactKind::vertex_face;

TYPED_TEST(EveryExpression, IsTheContactFunctionInRationals) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    Inputs inputs = random_inputs(random, TypeParam::coordinates);
    inputs.weights = random_weights<TypeParam>(random, 20);
    const bool edges = kind_of<TypeParam> == ContactKind::edge_edge;
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

// ---- Polynomials in time ------------------------------------------------------------------------

constexpr int trials = 300;

/// The determinant with these rows, by the rule of Sarrus.
mpq_class sarrus(const RationalVector& a, const RationalVector& b, const RationalVector& c) {
  return a[0] * b[1] * c[2] + a[1] * b[2] * c[0] + a[2] * b[0] * c[1] - a[2] * b[1] * c[0] -
         a[1] * b[0] * c[2] - a[0] * b[2] * c[1];
}

/// The inputs of the expressions in the order of their coordinates.
template <class... Vectors>
std::array<mpq_class, 3 * sizeof...(Vectors)> joined(const Vectors&... vectors) {
  std::array<mpq_class, 3 * sizeof...(Vectors)> x;
  std::size_t next = 0;
  const auto append = [&](const RationalVector& vector) {
    for (const mpq_class& coordinate : vector) x.at(next++) = coordinate;
  };
  (append(vectors), ...);
  return x;
}

/// The weights (1−t, t) of each of the times, the list repeated for each moving vector.
template <std::size_t vectors, class... Times>
std::array<mpq_class, 2 * vectors * sizeof...(Times)> weights_of(const Times&... times) {
  std::array<mpq_class, 2 * vectors * sizeof...(Times)> w;
  std::size_t next = 0;
  const auto append = [&](const mpq_class& time) {
    w.at(next++) = 1 - time;
    w.at(next++) = time;
  };
  for (std::size_t i = 0; i < vectors; ++i) (append(times), ...);
  return w;
}

/// By the Bernstein coefficients on [a,b], at a + s (b − a).
TEST(PolynomialExpressions, CoefficientsOfTheDeterminantAreItsOwn) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const auto [r, p, q] = random.three_motions();
    const auto x = joined(r.start, p.start, q.start, r.end, p.end, q.end);
    const auto end = [&x](const mpq_class& time) {
      return DeterminantEnd::evaluate(x, weights_of<3>(time));
    };
    const auto middle = [&x](const mpq_class& time, const mpq_class& other) {
      return DeterminantMiddle::evaluate(x, weights_of<3>(time, other));
    };
    const mpq_class a = random.fraction(), b = random.fraction(), s = random.fraction(), m = 1 - s;
    const mpq_class t = a + s * (b - a), truth = sarrus(r.at(t), p.at(t), q.at(t));
    EXPECT_EQ(mpq_class(m * m * m * end(a) + m * m * s * middle(a, b) + m * s * s * middle(b, a) +
                        s * s * s * end(b)),
              truth);
    EXPECT_EQ(end(t), truth);
  }
}

TEST(PolynomialExpressions, CoefficientsOfAnOrientationAreItsOwn) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const auto [x, y, other] = random.three_motions();
    const RationalVector d = other.start;
    const auto inputs = joined(d, x.start, y.start, x.end, y.end);
    const auto end = [&inputs](const mpq_class& time) {
      return OrientationEnd::evaluate(inputs, weights_of<2>(time));
    };
    const mpq_class a = random.fraction(), b = random.fraction(), s = random.fraction(), m = 1 - s;
    const mpq_class t = a + s * (b - a), truth = sarrus(x.at(t), d, y.at(t));
    const mpq_class middle = OrientationMiddle::evaluate(inputs, weights_of<2>(a, b));
    EXPECT_EQ(mpq_class(m * m * end(a) + m * s * middle + s * s * end(b)), truth);
    EXPECT_EQ(end(t), truth);
  }
}

TEST(PolynomialExpressions, NormalHasTheCoefficientsOfTheBlossom) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const auto [r, p, q] = random.three_motions();
    const mpq_class s = random.fraction(), m = 1 - s;
    const auto n_a = cross(p.start, q.start), n_b = cross(p.end, q.end);
    const auto twice_n_ab = normal_middle(p.start, p.end, q.start, q.end);
    const auto truth = cross(p.at(s), q.at(s));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mpq_class(m * m * n_a[k] + m * s * twice_n_ab[k] + s * s * n_b[k]), truth[k]);
    }
  }
}

TEST(PolynomialExpressions, GapIsTheProjectionOfTheDifference) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const RationalVector d = random.vector(), a = random.vector(), b = random.vector();
    EXPECT_EQ(ProjectedGap::evaluate(joined(d, a, b), {}), mpq_class(dot(d, a) - dot(d, b)));
    EXPECT_EQ(ProjectedGap::evaluate(joined(d, a, a), {}), 0);
  }
}

// ---- Separations --------------------------------------------------------------------------------

TEST(SeparationExpressions, GapIsHowFarACornerIsBeyondTheDistance) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const RationalVector d = random.vector();
    const auto [a0, a1] = random.motion();
    const auto [b0, b1] = random.motion();
    const mpq_class n = random.number(), distance = random.number(), t = random.fraction();
    const std::array<mpq_class, 17> x{d[0],  d[1],  d[2],  n,     a0[0],   a0[1],
                                      a0[2], b0[0], b0[1], b0[2], a1[0],   a1[1],
                                      a1[2], b1[0], b1[1], b1[2], distance};
    const RationalVector a = RationalMotion{a0, a1}.at(t), b = RationalMotion{b0, b1}.at(t);
    const mpq_class expected = dot(d, a) - dot(d, b) - n * distance;
    EXPECT_EQ(AdvancedGap::evaluate<mpq_class>(x, {1 - t, t}), expected);
    std::array<mpq_class, 19> ones;
    std::ranges::fill(ones, mpq_class(1));
    ones[0] = 1 - t;
    ones[1] = t;
    EXPECT_EQ(MeasuredAdvancedGap::evaluate<mpq_class>(x, ones), expected);
    EXPECT_EQ(CornerGap::evaluate<mpq_class>({d[0], d[1], d[2], n, a[0], a[1], a[2], distance}, {}),
              dot(d, a) - n * distance);
  }
}

TEST(SeparationExpressions, LengthsAreThoseOfTheNorms) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const RationalVector x = random.vector();
    const mpq_class distance = random.number();
    const mpq_class square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    EXPECT_EQ(ComponentSum::evaluate<mpq_class>(x, {}), x[0] + x[1] + x[2]);
    EXPECT_EQ(SquaredLength::evaluate<mpq_class>(x, {}), square);
    EXPECT_EQ(LengthDefect::evaluate<mpq_class>({x[0], x[1], x[2], distance}, {}),
              distance * distance - square);
  }
}

TEST(SeparationExpressions, ContactComponentIsFBeyondTheDistance) {
  SmallRationals random;
  for (int i = 0; i < trials; ++i) {
    const auto [start, end] = random.motion();  // r, p, q on one axis
    const mpq_class t = random.fraction(), u = random.fraction(), v = random.fraction();
    const mpq_class distance = random.number();
    const RationalVector now = RationalMotion{start, end}.at(t);
    EXPECT_EQ(
        ContactComponent::evaluate<mpq_class>(
            {start[0], start[1], start[2], end[0], end[1], end[2], distance}, {1 - t, t, u, v}),
        now[0] - u * now[1] - v * now[2] - distance);
  }
}

}  // namespace
}  // namespace touchstone::filters::expressions_test

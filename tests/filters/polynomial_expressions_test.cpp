#include "touchstone/filters/polynomial_expressions.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "tests/filters/support.hpp"

namespace touchstone::filters::polynomial_expressions_test {
namespace {

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

}  // namespace
}  // namespace touchstone::filters::polynomial_expressions_test

#include "touchstone/filters/polynomial_expressions.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace touchstone::filters::polynomial_expressions_test {
namespace {

/// A random integer, so small that expressions of a few of them do not round in double.
template <class Scalar>
Scalar small_integer(std::mt19937_64& random) {
  return Scalar(static_cast<double>(random() % 31) - 15);
}

/// A random multiple of 1/8 in [0,1].
template <class Scalar>
Scalar small_fraction(std::mt19937_64& random) {
  return Scalar(static_cast<double>(random() % 9) / 8);
}

/// The start of a motion and its end.
template <class Scalar>
struct Motion {
  Vector3<Scalar> start;
  Vector3<Scalar> end;

  [[nodiscard]] Vector3<Scalar> at(const Scalar& time) const {
    Vector3<Scalar> result;
    for (std::size_t i = 0; i < 3; ++i) result[i] = start[i] + time * (end[i] - start[i]);
    return result;
  }
};

template <class Scalar>
Vector3<Scalar> random_vector(std::mt19937_64& random) {
  return {small_integer<Scalar>(random), small_integer<Scalar>(random),
          small_integer<Scalar>(random)};
}

template <class Scalar>
Motion<Scalar> random_motion(std::mt19937_64& random) {
  return {random_vector<Scalar>(random), random_vector<Scalar>(random)};
}

template <class Scalar>
Vector3<Scalar> combined(const Vector3<Scalar>& a, const Scalar& x, const Vector3<Scalar>& b,
                         const Scalar& y) {
  Vector3<Scalar> result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] * x + b[i] * y;
  return result;
}

/// The determinant with these rows, by the rule of Sarrus.
template <class Scalar>
Scalar sarrus(const Vector3<Scalar>& a, const Vector3<Scalar>& b, const Vector3<Scalar>& c) {
  return a[0] * b[1] * c[2] + a[1] * b[2] * c[0] + a[2] * b[0] * c[1] - a[2] * b[1] * c[0] -
         a[1] * b[0] * c[2] - a[0] * b[2] * c[1];
}

/// The inputs of the expressions in the order of their coordinates.
template <class Scalar, class... Vectors>
std::array<Scalar, 3 * sizeof...(Vectors)> joined(const Vectors&... vectors) {
  std::array<Scalar, 3 * sizeof...(Vectors)> x;
  std::size_t next = 0;
  const auto append = [&](const Vector3<Scalar>& vector) {
    for (const Scalar& coordinate : vector) x.at(next++) = coordinate;
  };
  (append(vectors), ...);
  return x;
}

/// The weights (1−t, t) of each of the times, the list repeated for each moving vector.
template <std::size_t vectors, class Scalar, class... Times>
std::array<Scalar, 2 * vectors * sizeof...(Times)> weights_of(const Times&... times) {
  std::array<Scalar, 2 * vectors * sizeof...(Times)> w;
  std::size_t next = 0;
  const auto append = [&](const Scalar& time) {
    w.at(next++) = Scalar(1) - time;
    w.at(next++) = time;
  };
  for (std::size_t i = 0; i < vectors; ++i) (append(times), ...);
  return w;
}

/// Three moving vectors and their determinant's expressions.
template <class Scalar>
struct Three {
  Motion<Scalar> r, p, q;

  [[nodiscard]] std::array<Scalar, 18> inputs() const {
    return joined<Scalar>(r.start, p.start, q.start, r.end, p.end, q.end);
  }
  [[nodiscard]] Scalar end(const Scalar& time) const {
    return DeterminantEnd::evaluate(inputs(), weights_of<3, Scalar>(time));
  }
  [[nodiscard]] Scalar middle(const Scalar& a, const Scalar& b) const {
    return DeterminantMiddle::evaluate(inputs(), weights_of<3, Scalar>(a, b));
  }
  /// By the Bernstein coefficients on [a,b], at a + s (b − a).
  [[nodiscard]] Scalar by_coefficients(const Scalar& a, const Scalar& b, const Scalar& s) const {
    const Scalar m = Scalar(1) - s;
    return m * m * m * end(a) + m * m * s * middle(a, b) + m * s * s * middle(b, a) +
           s * s * s * end(b);
  }
};

/// A direction, two moving vectors, and the expressions of their orientation.
template <class Scalar>
struct Oriented {
  Vector3<Scalar> d;
  Motion<Scalar> x, y;

  [[nodiscard]] std::array<Scalar, 15> inputs() const {
    return joined<Scalar>(d, x.start, y.start, x.end, y.end);
  }
  [[nodiscard]] Scalar end(const Scalar& time) const {
    return OrientationEnd::evaluate(inputs(), weights_of<2, Scalar>(time));
  }
  [[nodiscard]] Scalar middle(const Scalar& a, const Scalar& b) const {
    return OrientationMiddle::evaluate(inputs(), weights_of<2, Scalar>(a, b));
  }
  [[nodiscard]] Scalar by_coefficients(const Scalar& a, const Scalar& b, const Scalar& s) const {
    const Scalar m = Scalar(1) - s;
    return m * m * end(a) + m * s * middle(a, b) + s * s * end(b);
  }
};

/// Tests in rationals, and in double on inputs without rounding.
template <class Scalar>
class PolynomialExpressions : public ::testing::Test {
 protected:
  [[nodiscard]] Three<Scalar> random_three() {
    return {random_motion<Scalar>(random_), random_motion<Scalar>(random_),
            random_motion<Scalar>(random_)};
  }
  [[nodiscard]] Oriented<Scalar> random_oriented() {
    return {random_vector<Scalar>(random_), random_motion<Scalar>(random_),
            random_motion<Scalar>(random_)};
  }
  [[nodiscard]] Scalar time() { return small_fraction<Scalar>(random_); }
  [[nodiscard]] Vector3<Scalar> vector() { return random_vector<Scalar>(random_); }

  static constexpr int trials = 300;

 private:
  std::mt19937_64 random_{1};
};

using Scalars = ::testing::Types<mpq_class, double>;
TYPED_TEST_SUITE(PolynomialExpressions, Scalars);

TYPED_TEST(PolynomialExpressions, CoefficientsOfTheDeterminantAreItsOwn) {
  for (int i = 0; i < this->trials; ++i) {
    const auto three = this->random_three();
    const TypeParam a = this->time(), b = this->time(), s = this->time(), t = a + s * (b - a);
    const TypeParam truth = sarrus(three.r.at(t), three.p.at(t), three.q.at(t));
    EXPECT_EQ(three.by_coefficients(a, b, s), truth);
    EXPECT_EQ(three.end(t), truth);
  }
}

TYPED_TEST(PolynomialExpressions, CoefficientsOfAnOrientationAreItsOwn) {
  for (int i = 0; i < this->trials; ++i) {
    const auto oriented = this->random_oriented();
    const TypeParam a = this->time(), b = this->time(), s = this->time(), t = a + s * (b - a);
    const TypeParam truth = sarrus(oriented.x.at(t), oriented.d, oriented.y.at(t));
    EXPECT_EQ(oriented.by_coefficients(a, b, s), truth);
    EXPECT_EQ(oriented.end(t), truth);
  }
}

TYPED_TEST(PolynomialExpressions, NormalHasTheCoefficientsOfTheBlossom) {
  for (int i = 0; i < this->trials; ++i) {
    const auto [r, p, q] = this->random_three();
    const TypeParam s = this->time(), m = TypeParam(1) - s;
    const auto n_a = cross(p.start, q.start), n_b = cross(p.end, q.end);
    const auto twice_n_ab = normal_middle(p.start, p.end, q.start, q.end);
    const auto truth = cross(p.at(s), q.at(s));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(m * m * n_a[k] + m * s * twice_n_ab[k] + s * s * n_b[k], truth[k]);
    }
  }
}

TYPED_TEST(PolynomialExpressions, GapIsTheProjectionOfTheDifference) {
  for (int i = 0; i < this->trials; ++i) {
    const auto d = this->vector(), a = this->vector(), b = this->vector();
    const auto difference = combined(a, TypeParam(1), b, TypeParam(-1));
    EXPECT_EQ(ProjectedGap::evaluate(joined<TypeParam>(d, a, b), {}), dot(d, difference));
    EXPECT_EQ(ProjectedGap::evaluate(joined<TypeParam>(d, a, a), {}), TypeParam(0));
  }
}

}  // namespace
}  // namespace touchstone::filters::polynomial_expressions_test

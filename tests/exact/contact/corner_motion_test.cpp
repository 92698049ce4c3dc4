#include "exact/contact/corner_motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::exact::corner_motion_test {
namespace {

using tests::Random;
using Vector = std::array<Rational, 3>;

constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_subnormal = std::numeric_limits<double>::denorm_min();

template <std::size_t degree>
Form<degree> random_form(Random& random, unsigned bits) {
  Form<degree> form;
  for (Integer& c : form.c) c = random.integer<Integer>(bits);
  return form;
}

/// Σ c_k (1−t)^(n−k) t^k, term by term.
template <std::size_t degree>
Rational value(const Form<degree>& form, const Rational& t) {
  Rational sum = 0;
  for (std::size_t k = 0; k <= degree; ++k) {
    Rational term = form.c[k];
    for (std::size_t i = 0; i < degree; ++i) term *= i < k ? t : Rational(1 - t);
    sum += term;
  }
  return sum;
}

Rational value(const Polynomial& p, const Rational& t) {
  Rational sum = 0, term = 1;
  for (const Integer& c : p.coefficients()) {
    sum += c * term;
    term *= t;
  }
  return sum;
}

/// A time that may be outside [0,1]: identities of polynomials hold everywhere.
Rational random_time(Random& random) { return Rational(random.between(-50, 150)) / 101; }

// ---- Forms --------------------------------------------------------------------------------------

/// Sums, products and the polynomial of forms are those of their values.
template <std::size_t m, std::size_t n>
void expect_arithmetic(Random& random) {
  for (int round = 0; round < 50; ++round) {
    const Form<m> a = random_form<m>(random, 60), other = random_form<m>(random, 60);
    const Form<n> b = random_form<n>(random, 60);
    const Form<m + n> start = random_form<m + n>(random, 60);
    const Rational t = random_time(random), product = value(a, t) * value(b, t);
    EXPECT_EQ(value(a * b, t), product);
    Form<m + n> sum = start;
    add_product(sum, a, b);
    EXPECT_EQ(value(sum, t), Rational(value(start, t) + product));
    subtract_product(sum, a, b);
    EXPECT_EQ(sum.c, start.c);
    subtract_product(sum, a, b);
    EXPECT_EQ(value(sum, t), Rational(value(start, t) - product));
    EXPECT_EQ(value(a + other, t), Rational(value(a, t) + value(other, t)));
    EXPECT_EQ(value(a - other, t), Rational(value(a, t) - value(other, t)));
    EXPECT_EQ(value(-a, t), Rational(-value(a, t)));
    Form<m> c = a;
    c += other;
    EXPECT_EQ(c.c, (a + other).c);
    c -= other;
    EXPECT_EQ(c.c, a.c);
    EXPECT_EQ(value(multiple(a, Integer(-4)), t), Rational(-4 * value(a, t)));
    EXPECT_EQ(value(one<m>(), t), 1);
    EXPECT_EQ(to_polynomial(one<m>()), Polynomial(Integer(1)));
    EXPECT_TRUE(Form<m>{}.is_zero());
    EXPECT_TRUE(to_polynomial(Form<m>{}).is_zero());
    EXPECT_LE(to_polynomial(a).degree(), m);
    EXPECT_EQ(value(to_polynomial(a), t), value(a, t));
  }
}

TEST(Form, CalculatesAsItsValuesDo) {
  Random random(71);
  expect_arithmetic<0, 0>(random);
  expect_arithmetic<0, 2>(random);
  expect_arithmetic<1, 1>(random);
  expect_arithmetic<2, 1>(random);
  expect_arithmetic<3, 2>(random);
  expect_arithmetic<6, 0>(random);
}

TEST(Form, IsZeroWhereAllCoefficientsAre) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (const int entry : {1, -1}) {
      Form<2> form;
      form.c[k] = entry;
      EXPECT_FALSE(form.is_zero());
    }
  }
}

// ---- Signs of forms -----------------------------------------------------------------------------

/// The number `value` as the only root in [0,1] of (den·t − num)(t² + t + 1); not known to be
/// rational unless it is 0 or 1.
AlgebraicNumber hidden(const Rational& value) {
  const Polynomial p = Polynomial(Integer(-value.get_num()), value.get_den()) *
                       Polynomial(Integer(1), Integer(1), Integer(1));
  return roots_in_unit_interval(p).at(0);
}

/// Random coefficients, zero or small, so that every pattern of signs and zeros occurs.
Form<3> random_sparse_form(Random& random) {
  Form<3> form;
  for (Integer& c : form.c) c = random.between(-2, 2);
  return form;
}

TEST(SignOfForm, AtRationalTimes) {
  Random random(75);
  for (int round = 0; round < 2000; ++round) {
    const Form<3> form = random_sparse_form(random);
    const Rational t = Rational(random.between(0, 12)) / 12;
    AlgebraicNumber known(t), unknown = hidden(t);
    EXPECT_EQ(sign_at(form, known), sgn(value(form, t)));
    EXPECT_EQ(sign_at(form, unknown), sgn(value(form, t)));
  }
}

/// a + b√2.
struct Surd {
  Rational a, b;
};

Surd operator*(const Surd& x, const Surd& y) {
  return {x.a * y.a + 2 * x.b * y.b, x.a * y.b + x.b * y.a};
}

int sign(const Surd& x) {
  if (sgn(x.a) * sgn(x.b) >= 0) return sgn(x.a) != 0 ? sgn(x.a) : sgn(x.b);
  return sgn(x.a) * cmp(Rational(x.a * x.a), Rational(2 * x.b * x.b));
}

TEST(SignOfForm, AtAnIrrationalTime) {
  Random random(76);
  const std::vector<AlgebraicNumber> roots =
      roots_in_unit_interval(Polynomial(Integer(-1), Integer(0), Integer(2)));
  ASSERT_EQ(roots.size(), 1U);
  const Rational half(1, 2);
  const Surd t{0, half}, s{1, -half};  // √2/2 and 1 − √2/2
  for (int round = 0; round < 1000; ++round) {
    const Form<3> form = random_sparse_form(random);
    const std::array<Surd, 4> terms{s * s * s, s * s * t, s * t * t, t * t * t};
    Surd sum{0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
      sum.a += form.c[k] * terms[k].a;
      sum.b += form.c[k] * terms[k].b;
    }
    AlgebraicNumber time = roots.front();
    EXPECT_EQ(sign_at(form, time), sign(sum));
  }
}

TEST(SignOfForm, IsZeroWhereTheFormHasTheSameIrrationalRoot) {
  // 2t² − 1 = −(1−t)² − 2(1−t)t + t².
  const Form<2> form{{Integer(-1), Integer(-2), Integer(1)}};
  AlgebraicNumber t = roots_in_unit_interval(to_polynomial(form)).at(0);
  EXPECT_EQ(sign_at(form, t), 0);
  EXPECT_EQ(sign_at(form * form, t), 0);
  EXPECT_EQ(sign_at(form + one<2>(), t), 1);
  EXPECT_EQ(sign_at(form - one<2>(), t), -1);
}

// ---- Motions ------------------------------------------------------------------------------------

/// Random coordinates of every size, some zero and some equal.
Query random_query(Random& random, int flavour) {
  Query query{};
  for (double& x : query.coordinates) {
    switch (flavour) {
      case 0:
        x = random.few_bit_double(3, -2, 2);
        break;
      case 1:
        x = random.uniform(-10.0, 10.0);
        break;
      case 2:
        x = random.finite_double();
        break;
      default:
        x = random.few_bit_double(10, -1074, -1060);
    }
    if (random.between(0, 9) == 0) x = random.coin() ? 0.0 : -0.0;
  }
  return query;
}

bool is_power_of_two(const Rational& x) {
  return sgn(x) > 0 && mpz_popcount(x.get_num_mpz_t()) == 1 && mpz_popcount(x.get_den_mpz_t()) == 1;
}

/// The scaled coordinate over the original one; zero if both are zero.
Rational ratio(const Integer& scaled, double original) {
  if (original == 0.0) {
    EXPECT_EQ(scaled, 0);
    return 0;
  }
  return Rational(scaled) / Rational(original);
}

/// Checks that each axis is multiplied by one power of two, and returns the three (1 for an axis of
/// zeros).
Vector scales(const Query& query, const Motion& motion) {
  Vector result{1, 1, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool known = false;
    for (std::size_t i = 0; i < query_points; ++i) {
      const std::size_t end = i / moving_points, point = i % moving_points;
      const Rational scale = ratio(motion.points[point][axis].c[end], query.at(end, point, axis));
      if (sgn(scale) == 0) continue;
      if (!known) result[axis] = scale;
      known = true;
      EXPECT_EQ(scale, result[axis]);
    }
    EXPECT_TRUE(is_power_of_two(result[axis]));
  }
  return result;
}

TEST(ScaleToIntegers, SpansTheWholeRangeOfDoubles) {
  Query query{};
  query.at(0, 0, 0) = least_subnormal;
  query.at(1, 0, 0) = std::numeric_limits<double>::max();
  query.at(0, 1, 1) = -0x1p1000;
  query.at(1, 3, 1) = 0x1.8p1001;
  const Motion motion = scale_to_integers(Kind::edge_edge, query);
  const Vector scale = scales(query, motion);
  EXPECT_EQ(Rational(motion.points[0][0].c[0]), Rational(least_subnormal) * scale[0]);
  EXPECT_EQ(Rational(motion.points[0][0].c[1]),
            Rational(std::numeric_limits<double>::max()) * scale[0]);
  for (const auto& point : motion.points) EXPECT_TRUE(point[2].is_zero());
  query.coordinates.fill(-0.0);
  EXPECT_TRUE(determinant(scale_to_integers(Kind::vertex_face, query)).is_zero());
}

TEST(ScaleToIntegers, NanAndInfinityAreErrorsEverywhere) {
  Random random(78);
  const Query query = random_query(random, 1);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    for (std::size_t i = 0; i < query.coordinates.size(); ++i) {
      Query broken = query;
      broken.coordinates[i] = bad;
      for (const Kind kind : kinds) {
        EXPECT_THROW(static_cast<void>(scale_to_integers(kind, broken)), std::domain_error) << i;
      }
    }
  }
}

TEST(ScaleUniformly, MultipliesAllAxesByOnePowerOfTwo) {
  Query query{};
  query.at(0, 0, 0) = 3.0;
  query.at(1, 2, 1) = -0.25;
  query.at(0, 3, 2) = 1024.0;
  const Motion motion = scale_uniformly(Kind::edge_edge, query);
  EXPECT_EQ(motion.points[0][0].c[0], 12);
  EXPECT_EQ(motion.points[2][1].c[1], -1);
  EXPECT_EQ(motion.points[3][2].c[0], 4096);
  EXPECT_EQ(motion.corners[0][0].c[0], 12);  // ea0 − eb0
  EXPECT_EQ(motion.corners[1][1].c[1], 1);
  EXPECT_EQ(motion.corners[2][2].c[0], -4096);
  EXPECT_EQ(motion.distance, 0);
}

TEST(ScaleUniformly, TakesEveryFiniteDouble) {
  constexpr double greatest = std::numeric_limits<double>::max();
  Query query{};
  query.at(0, 0, 0) = least_subnormal;
  query.at(0, 0, 1) = greatest;
  const Motion motion = scale_uniformly(Kind::vertex_face, query);
  EXPECT_EQ(motion.corners[0][0].c[0], 1);
  EXPECT_EQ(Rational(motion.corners[0][1].c[0]), Rational(greatest) * power_of_two(1074));
  EXPECT_EQ(scale_uniformly(Kind::vertex_face, Query{}).corners[2][2].c[1], 0);
  query.at(1, 1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(scale_uniformly(Kind::vertex_face, query)), std::domain_error);
}

TEST(ScaleUniformly, TakesTheDistanceAlong) {
  Query query{};
  query.at(0, 0, 0) = 3.0;
  const Motion coarse = scale_uniformly(Kind::vertex_face, query, {6.0, Norm::linf});
  EXPECT_EQ(coarse.points[0][0].c[0], 3);
  EXPECT_EQ(coarse.distance, 6);
  EXPECT_EQ(coarse.norm, Norm::linf);
  const Motion fine = scale_uniformly(Kind::vertex_face, query, {0.125, Norm::l2});
  EXPECT_EQ(fine.points[0][0].c[0], 24);
  EXPECT_EQ(fine.distance, 1);
  EXPECT_EQ(fine.norm, Norm::l2);
  const Motion finest = scale_uniformly(Kind::vertex_face, query, {least_subnormal, Norm::l2});
  EXPECT_EQ(finest.distance, 1);
  EXPECT_EQ(Rational(finest.points[0][0].c[0]), 3 * power_of_two(1074));
  EXPECT_EQ(scale_uniformly(Kind::vertex_face, Query{}, {0.75, Norm::l2}).distance, 3);
  for (const double bad :
       {-1.0, -least_subnormal, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(scale_uniformly(Kind::vertex_face, query, {bad, Norm::l2})),
                 std::invalid_argument);
  }
}

// ---- The polynomials in time, against vectors at one time ---------------------------------------

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational inner(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// The corners at time t, from the query's own coordinates and the scales of the axes.
std::vector<Vector> corners_at(Kind kind, const Query& query, const Vector& scale,
                               const Rational& t) {
  std::vector<Vector> result;
  for (const auto& [plus, minus, u, v] : touchstone::corners(kind)) {
    Vector& corner = result.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Rational start = Rational(query.at(0, plus, axis)) - Rational(query.at(0, minus, axis));
      const Rational end = Rational(query.at(1, plus, axis)) - Rational(query.at(1, minus, axis));
      corner[axis] = scale[axis] * (start + t * (end - start));
    }
  }
  return result;
}

TEST(Motion, HasThePolynomialsOfItsVectors) {
  Random random(80);
  for (int round = 0; round < 200; ++round) {
    const Query query = random_query(random, round % 4);
    for (const Kind kind : kinds) {
      const Motion motion = scale_to_integers(kind, query);
      EXPECT_EQ(motion.kind, kind);
      const Rational t = random_time(random);
      const std::vector<Vector> w = corners_at(kind, query, scales(query, motion), t);
      ASSERT_EQ(motion.corner_count, w.size());
      const Vector normal = cross(minus(w[1], w[0]), minus(w.back(), w[0]));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(value(normal_component(motion, axis), t), normal[axis]);
      }
      for (std::size_t i = 0; i < w.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(value(motion.corners[i][axis], t), w[i][axis]);
        }
        for (std::size_t j = 0; j < w.size(); ++j) {
          EXPECT_EQ(value(dot(motion, i, j), t), inner(w[i], w[j]));
          const Vector product = cross(w[i], w[j]);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(value(cross_component(motion, i, j, axis), t), product[axis]);
          }
        }
        // The origin's plane gives the same number by the normal and any corner.
        EXPECT_EQ(value(determinant(motion), t), inner(normal, w[i]));
      }
    }
  }
}

}  // namespace
}  // namespace touchstone::exact::corner_motion_test

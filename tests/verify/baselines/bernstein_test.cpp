/// \file
/// The forms against their definitions, and the theorems as identities, in exact numbers: forms are
/// evaluated at t : s with integers, so both sides are integers.

#include "verify/baselines/bernstein.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "verify/baselines/exact_number.hpp"

namespace touchstone::baselines::bernstein_test {
namespace {

using Number = ExactNumber;

/// A time t/(t+s).
struct Time {
  Number t, s;

  [[nodiscard]] Number sum() const { return t + s; }
};

Time random_time(tests::Random& random) { return {random.between(0, 20), random.between(1, 20)}; }

Number random_number(tests::Random& random) { return random.between(-9, 9); }

template <std::size_t degree>
Bernstein<Number, degree> random_form(tests::Random& random) {
  Bernstein<Number, degree> form;
  for (Number& x : form) x = random_number(random);
  return form;
}

Number value(const Bernstein<Number, 1>& q, const Time& at) { return q[0] * at.s + q[1] * at.t; }
Number value(const Bernstein<Number, 2>& q, const Time& at) { return value_at(q, at.t, at.s); }
Number value(const Bernstein<Number, 3>& q, const Time& at) { return value_at(q, at.t, at.s); }
/// The value by de Casteljau's steps, not by the binomial theorem.
template <std::size_t degree>
Number casteljau(Bernstein<Number, degree> q, const Time& at) {
  for (std::size_t step = degree; step > 0; --step) {
    for (std::size_t i = 0; i < step; ++i) q[i] = at.s * q[i] + at.t * q[i + 1];
  }
  return q[0];
}

/// A point at a time, times t + s.
Vector<Number> position(const Moving<Number>& point, const Time& at) {
  Vector<Number> result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = at.s * point[0][i] + at.t * point[1][i];
  return result;
}

TEST(Forms, AreTheirDefinitions) {
  tests::Random random(2);
  for (int trial = 0; trial < tests::trials(200); ++trial) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      const Query query = tests::integer_query(random, 5);
      const auto points = moving_points_of(kind, scaled_to_integers(query.coordinates, 1));
      const auto normal = normal_of(points);
      const Time at = random_time(random);
      const auto a = position(points[0], at), b = position(points[1], at);
      const auto c = position(points[2], at), d = position(points[3], at);
      const auto n = cross(b - a, c - a);
      EXPECT_TRUE(value(coplanarity(points, normal), at) == Number(3) * dot(n, d - a));
      const std::array m{cross(b - d, c - d), cross(c - d, a - d), cross(a - d, b - d)};
      for (std::size_t i = 0; i < 3; ++i) {
        const Number sign = kind == Kind::edge_edge && i == 2 ? -1 : 1;
        EXPECT_TRUE(casteljau<4>(inside(kind, points, normal, i), at) ==
                    sign * Number(6) * dot(m[i], n));
      }
    }
  }
}

TEST(Reduction, IsGWithoutAMultipleOfY) {
  tests::Random random(3);
  for (int trial = 0; trial < tests::trials(1000); ++trial) {
    const auto k = random_form<3>(random);
    const auto l = random_form<4>(random);
    const Time at = random_time(random);
    const Number y = value(k, at), g = casteljau<4>(l, at), j = value(reduce(k, l), at);
    const Number s0 = Number(12) * (l[1] * Number(4) * k[0] - l[0] * (k[0] + Number(3) * k[1]));
    EXPECT_TRUE(at.t * at.t * j == Number(24) * k[0] * k[0] * g -
                                       Number(24) * k[0] * l[0] * y * at.sum() -
                                       Number(2) * at.t * s0 * y);
  }
}

TEST(Decomposition, IsDivisionWithRemainder) {
  tests::Random random(4);
  for (int trial = 0; trial < tests::trials(1000); ++trial) {
    const auto k = random_form<3>(random);
    const auto j = random_form<2>(random);
    const auto parts = decompose(k, j);
    const Time at = random_time(random);
    EXPECT_TRUE(parts.t * value(k, at) ==
                value(parts.l, at) * value(j, at) + value(parts.k, at) * at.sum() * at.sum());
    const Number root = Number(2) * j[1] - j[0] - j[2];
    EXPECT_TRUE(parts.t == root * root);
  }
}

}  // namespace
}  // namespace touchstone::baselines::bernstein_test

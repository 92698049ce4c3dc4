#include "fast/certified/exact/contact_conditions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "exact/oracle.hpp"
#include "fast/certified/exact/big_integer.hpp"
#include "fast/certified/exact/fixed_integer.hpp"
#include "tests/fast/certified/decisions.hpp"

namespace touchstone::fast::exact_stage::contact_conditions_test {
namespace {

using tests::integer_motion;
using tests::PosedQuery;
using tests::Random;

/// Contact of the points at t=0, by theorem 1, and (u,v).
struct AtStart {
  bool contact = false;
  exact::Rational u, v;
};

template <class Number>
AtStart at_start(const PosedQuery& posed) {
  const Motion<Number> motion = integer_motion<Number>(posed);
  const auto n = normal(motion);
  if (determinant(motion, n)[0].sign() != 0) return {};
  const auto contact = contact_in_plane(motion, n, [](const auto& form) { return form[0].sign(); });
  if (!contact) return {};
  const auto number = [](const auto& x) -> exact::Rational {
    if constexpr (std::is_same_v<Number, BigInteger>) {
      return exact::Rational(x.approximation().significand) *
             exact::power_of_two(x.approximation().exponent);
    } else {
      return exact::Rational(x.rounded());
    }
  };
  const exact::Rational denominator = number(contact->denominator[0]);
  if (denominator == 0) return {true, 0, 0};
  return {true, number(contact->u[0]) / denominator, number(contact->v[0]) / denominator};
}

/// A query whose points rest: contact at all times or never.
PosedQuery resting(Random& random, Kind kind, int bound) {
  PosedQuery posed{kind, tests::integer_query(random, bound)};
  for (std::size_t i = 0; i < moving_points; ++i) posed.query.point(1, i) = posed.query.point(0, i);
  return posed;
}

template <class Number>
void expect_truth_of_resting(const PosedQuery& posed) {
  const AtStart result = at_start<Number>(posed);
  ASSERT_EQ(result.contact, exact::decide(posed.kind, posed.query).collides()) << posed;
  if (!result.contact) return;
  EXPECT_GE(result.u, 0) << posed;
  EXPECT_GE(result.v, 0) << posed;
  EXPECT_LE(posed.kind == Kind::vertex_face ? exact::Rational(result.u + result.v)
                                            : std::max(result.u, result.v),
            1)
      << posed;
  const auto f = contact_function<exact::Rational>(posed.kind, posed.query, 0, result.u, result.v);
  for (const exact::Rational& x : f) EXPECT_EQ(x, 0) << posed;
}

TEST(ContactRule, DecidesRestingQueriesOfAllDegeneracies) {
  Random random(1);
  int contacts = 0, on_lines = 0;
  for (int i = 0; i < 20000; ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const PosedQuery posed = resting(random, kind, 1 + i % 3);
    expect_truth_of_resting<FixedInteger<1>>(posed);
    if (i % 4 < 2) expect_truth_of_resting<BigInteger>(posed);
    const auto n = normal(integer_motion<FixedInteger<1>>(posed));
    const bool line = is_zero(n[0]) && is_zero(n[1]) && is_zero(n[2]);
    const bool contact = at_start<FixedInteger<1>>(posed).contact;
    contacts += contact ? 1 : 0;
    on_lines += contact && line ? 1 : 0;
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(on_lines, 200);
}

TEST(ContactRule, DeterminantIsTheOneOfTheMovingVectors) {
  // p and q at rest along x and y, r at height 2 − 5t: D = r_z.
  Motion<FixedInteger<1>> motion{};
  const FixedInteger<1> one(std::int64_t{1});
  motion.p[0] = {one, one};
  motion.q[1] = {one, one};
  motion.r[2] = {FixedInteger<1>(std::int64_t{2}), FixedInteger<1>(std::int64_t{-3})};
  const auto d = determinant(motion, normal(motion));
  // (2x − 3y)(x + y)²
  const std::array<std::int64_t, 4> expected{2, 1, -4, -3};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_TRUE(d[i] == FixedInteger<3>(expected[i]));
}

TEST(ContactRule, EventsOfMotionInAPlaneIncludeTheFirstContact) {
  Random random(2);
  int found = 0;
  for (int i = 0; i < 3000; ++i) {
    PosedQuery posed{i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge,
                     tests::integer_query(random, 3)};
    tests::flatten(posed.query, 2);
    const auto truth = exact::decide(posed.kind, posed.query);
    if (!truth.collides() || *truth.toi == exact::Rational(0)) continue;
    const Motion<BigInteger> motion = integer_motion<BigInteger>(posed);
    bool is_event = false;
    for (const auto& event : events_in_plane(motion, normal(motion))) {
      const auto c = [&](std::size_t k) {
        return exact::Integer(
            static_cast<long>(std::ldexp(event[k].approximation().significand,
                                         static_cast<int>(event[k].approximation().exponent))));
      };
      // c0 (1−t)² + c1 (1−t) t + c2 t²
      const exact::Integer linear = c(1) - 2 * c(0), square = c(0) - c(1) + c(2);
      const exact::Polynomial in_t(c(0), linear, square);
      is_event = is_event || truth.toi->is_root_of(in_t);
    }
    EXPECT_TRUE(is_event) << posed;
    ++found;
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::contact_conditions_test

#include "exact/distance/distance_oracle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/support/distance_reference.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::distance_oracle_test {
namespace {

using tests::edge_edge;
using tests::over_edge;
using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;
using tests::vertex_face;

constexpr std::array<Norm, 2> both_norms{Norm::linf, Norm::l2};
using Limits = std::numeric_limits<double>;

std::optional<AlgebraicNumber> toi(const PosedQuery& posed, double distance, Norm norm) {
  return decide(posed.kind, posed.query, {distance, norm}).toi;
}

void expect_toi(const PosedQuery& posed, double distance, Norm norm, const Rational& expected) {
  const auto found = toi(posed, distance, norm);
  ASSERT_TRUE(found) << to_string(norm) << ' ' << distance << ' ' << posed;
  EXPECT_TRUE(*found == expected) << to_string(norm) << ' ' << distance << ' ' << posed;
}

/// Expects contact at this distance from `time` on, and at no smaller distance before.
void expect_from(const PosedQuery& posed, double distance, Norm norm, const Rational& time) {
  expect_toi(posed, distance, norm, time);
  const auto later = toi(posed, std::nextafter(distance, 0.0), norm);
  EXPECT_TRUE(!later || *later > time) << posed;
  const auto earlier = toi(posed, std::nextafter(distance, 100 * distance), norm);
  EXPECT_TRUE(earlier && (*earlier < time || *earlier == Rational(0))) << posed;
}

/// Expects that a is no later than b, if b exists.
void expect_no_later(const std::optional<AlgebraicNumber>& a,
                     const std::optional<AlgebraicNumber>& b, const PosedQuery& posed) {
  if (!b) return;
  ASSERT_TRUE(a) << posed;
  EXPECT_TRUE(*a <= *b) << posed;
}

void expect_same(const std::optional<AlgebraicNumber>& a, const std::optional<AlgebraicNumber>& b,
                 const PosedQuery& posed) {
  ASSERT_EQ(a.has_value(), b.has_value()) << posed;
  if (a) {
    EXPECT_TRUE(*a == *b) << posed;
  }
}

// ---- Known answers ------------------------------------------------------------------------------

/// A query with a distance in l2 and one in linf, each reached exactly at its time.
struct Known {
  PosedQuery posed;
  double in_l2, in_linf;
  Rational time_in_l2, time_in_linf;
};

PosedQuery at_rest(Kind kind, const tests::FourPoints& points) {
  return {kind, tests::moving(points, points)};
}

TEST(DistanceOracle, KnowsWhenDistancesAreReached) {
  const Rational half(1, 2), eighths(3, 8);
  // (−3,−4,12) is 13 from the corner, and 12 in linf; (2,−3) is 3 from the side, (7,2) 3 from the
  // end of an edge; the heights are 3 − 4t, 16 − 8t and 8 − 8t.
  std::vector<Known> all{
      {over_triangle(-3, -4, 16, 8), 13, 13, half, eighths},
      {edge_edge({0, 0, 0, 4, 0, 0, -1, 3, 0, 3, 3, 0}, {0, 0, 0, 4, 0, 0, -1, 1, 0, 3, 1, 0}), 2,
       2, half, half},
      // A path past a point, nearest at t=1/2 with sides of 3 and 4.
      {vertex_face({-1, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 5,
       4, half, 0},
      // Primitives that are points or segments, and a place inside of one.
      {at_rest(Kind::vertex_face, {3, 4, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0}), 13, 12, 0, 0},
      {at_rest(Kind::edge_edge, {3, 4, 12, 3, 4, 12, 0, 0, 0, 0, 0, 0}), 13, 12, 0, 0},
      {at_rest(Kind::vertex_face, {3, 4, 12, 0, 0, 0, -4, 0, 0, -2, 0, 0}), 13, 12, 0, 0},
      {at_rest(Kind::edge_edge, {3, 4, 12, 3, 4, 12, 0, 0, 0, 0, -5, 0}), 13, 12, 0, 0},
      {at_rest(Kind::edge_edge, {3, 4, 12, 5, 4, 12, 0, 0, 0, -1, 0, 0}), 13, 12, 0, 0},
      {at_rest(Kind::vertex_face, {2, 3, 4, 0, 0, 0, 4, 0, 0, 1, 0, 0}), 5, 4, 0, 0},
      {at_rest(Kind::edge_edge, {2, 3, 4, 2, 3, 4, 0, 0, 0, 4, 0, 0}), 5, 4, 0, 0}};
  for (const PosedQuery& posed : {over_triangle(1, 1, 3, -1), over_edge(1, 2, 3, -1)}) {
    all.push_back({posed, 1, 2.5, half, Rational(1, 8)});
    all.push_back({posed, 2.5, 1, Rational(1, 8), half});
    all.push_back({posed, 3, 3, 0, 0});
    for (const Norm norm : both_norms) expect_toi(posed, 1e-100, norm, (3 - Rational(1e-100)) / 4);
  }
  for (const PosedQuery& posed : {over_triangle(2, -3, 8, 0), over_edge(7, 2, 8, 0)}) {
    all.push_back({posed, 5, 5, half, eighths});
    all.push_back({posed, 3, 3, 1, Rational(5, 8)});
  }
  for (const auto& [posed, in_l2, in_linf, time_in_l2, time_in_linf] : all) {
    expect_from(posed, in_l2, Norm::l2, time_in_l2);
    expect_from(posed, in_linf, Norm::linf, time_in_linf);
  }
  for (const Norm norm : both_norms) {
    EXPECT_FALSE(toi(over_triangle(1, 1, 3, 1.5), 1, norm));
    EXPECT_FALSE(toi(over_triangle(1, 1, -3, -1.5), 1, norm));
  }
}

TEST(DistanceOracle, AnIrrationalTime) {
  // From (s,s,s), s = 3 − 2t, to a triangle that is the origin: |(s,s,s)|² = 3s² = 4.
  const PosedQuery posed =
      vertex_face({3, 3, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  expect_from(posed, 2, Norm::linf, Rational(1, 2));
  auto found = toi(posed, 2, Norm::l2);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign_of(Polynomial(Integer(23), Integer(-36), Integer(12))), 0);
  EXPECT_TRUE(*found < Rational(1));
}

TEST(DistanceOracle, ACubesEdgeAgainstASide) {
  // The triangle's side lies in x = y, z = 0, and an edge of the cube about the vertex meets it
  // when the vertex is at (1 + s, 1 − s, 0), at distance s in linf and √2 s in l2.
  const std::array<double, 9> face{0, 0, 0, 8, 8, 0, 4, 4, -8};
  const PosedQuery posed =
      vertex_face(tests::with_vertex(5, -3, 0, face), tests::with_vertex(1, 1, 0, face));
  expect_from(posed, 1, Norm::linf, Rational(3, 4));
  auto found = toi(posed, 1, Norm::l2);  // s = 4 − 4t, 2s² = 1
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sign_of(Polynomial(Integer(31), Integer(-64), Integer(32))), 0);
}

TEST(DistanceOracle, AnyMagnitude) {
  for (const Norm norm : both_norms) {
    // The height 3u − 4ut at distance u, the least double.
    const double u = Limits::denorm_min();
    expect_toi(over_triangle(1, 1, 3 * u, -u), u, norm, Rational(1, 2));
    expect_toi(over_triangle(1, 1, 3, 1), Limits::max(), norm, 0);
    expect_toi(over_triangle(1, 1, Limits::max(), 0), 1, norm, 1 - 1 / Rational(Limits::max()));
    expect_toi(over_triangle(1, 1, 3, -1), u, norm, (3 - Rational(u)) / 4);
    EXPECT_FALSE(toi(over_triangle(1, 1, 3, 2 * u), u, norm));
  }
}

TEST(DistanceOracle, FlushedSubnormalsChangeNothing) {
  const double u = Limits::denorm_min();
  const PosedQuery posed = over_triangle(1, 1, 3 * u, 2 * u);
  const std::uint64_t modes = tests::floating_point_modes();
  tests::set_floating_point_modes(modes | tests::flush_to_zero | tests::subnormals_are_zero);
  std::vector<bool> collisions;
  for (const Norm norm : both_norms) {
    collisions.push_back(decide(posed.kind, posed.query, {u, norm}).collides());
    collisions.push_back(decide(posed.kind, posed.query, {2 * Limits::min(), norm}).collides());
  }
  bool is_refused = false;
  try {
    static_cast<void>(decide(posed.kind, posed.query, {-u, Norm::l2}));
  } catch (const std::invalid_argument&) {
    is_refused = true;
  }
  tests::set_floating_point_modes(modes);
  EXPECT_EQ(collisions, (std::vector<bool>{false, true, false, true}));
  EXPECT_TRUE(is_refused);
  expect_toi(posed, 2 * u, Norm::l2, 1);
}

TEST(DistanceOracle, RefusesInvalidQueriesAndSeparations) {
  PosedQuery posed = over_triangle(1, 1, 3, 1);
  for (const double distance :
       {-1.0, -Limits::denorm_min(), Limits::infinity(), Limits::quiet_NaN()}) {
    EXPECT_THROW(static_cast<void>(toi(posed, distance, Norm::l2)), std::invalid_argument);
  }
  posed.query.coordinates[7] = Limits::quiet_NaN();
  EXPECT_THROW(static_cast<void>(toi(posed, 1, Norm::l2)), std::domain_error);
  EXPECT_THROW(static_cast<void>(toi(posed, 0, Norm::linf)), std::domain_error);
}

// ---- Against other ways to the answer -----------------------------------------------------------

/// A query of small integers, which is often degenerate; halves and thirds of a unit hardly ever
/// are contacts.
PosedQuery small_query(Random& random) {
  const Kind kind = random.coin() ? Kind::vertex_face : Kind::edge_edge;
  PosedQuery posed = tests::random_query(
      random, kind, random.coin() ? tests::Family::tiny_integers : tests::Family::small_integers);
  // Primitives moved apart: otherwise almost all would be near from the start.
  if (random.coin()) {
    const auto axis = static_cast<std::size_t>(random.between(0, 2));
    const double shift = random.between(2, 5);
    const bool is_vertex = kind == Kind::vertex_face;
    for (const std::size_t end : {0U, 1U}) {
      posed.query.at(end, 0, axis) += shift;
      if (!is_vertex) posed.query.at(end, 1, axis) += shift;
    }
  }
  return posed;
}

double small_distance(Random& random) {
  static constexpr std::array distances{0.5, 1.0, 1.0, 2.0, 3.0, 1.25, 0x1p-10, 0.0};
  return distances.at(static_cast<std::size_t>(random.between(0, 7)));
}

TEST(DistanceOracle, AgreesWithTheEvaluationOfAllCandidates) {
  Random random(12);
  const int count = tests::is_soak() ? 30000 : 150;
  int later = 0, no_collisions = 0;
  for (int i = 0; i < count; ++i) {
    const PosedQuery posed = small_query(random);
    const double distance = small_distance(random);
    tests::DistanceReference reference(posed, distance);
    for (const Norm norm : both_norms) {
      const auto expected = reference.toi(norm);
      const auto motion = scale_uniformly(posed.kind, posed.query, {distance, norm});
      expect_same(decide_distance(motion).toi, expected, posed);
      if (HasFailure()) FAIL() << to_string(norm) << ' ' << distance;
      later += expected && *expected > Rational(0) ? 1 : 0;
      no_collisions += expected ? 0 : 1;
    }
  }
  EXPECT_GT(later, count / 8);
  EXPECT_GT(no_collisions, count / 8);
}

// ---- Relations between distances -----------------------------------------------------------------

TEST(DistanceOracle, GreaterDistancesAndTheOtherNormBoundTheToi) {
  Random random(14);
  for (int i = 0; i < 250 && !HasFailure(); ++i) {
    PosedQuery posed = small_query(random);
    if (i % 3 == 0) {
      const tests::Family family = tests::all_families.at(2 + static_cast<unsigned>(i) % 2U);
      posed = tests::random_query(random, posed.kind, family);
    }
    const double distance = random.coin() ? small_distance(random) : random.uniform(0.0, 1.5);
    for (const Norm norm : both_norms) {
      const auto found = toi(posed, distance, norm);
      expect_no_later(toi(posed, std::nextafter(distance, HUGE_VAL), norm), found, posed);
      expect_no_later(toi(posed, distance + random.uniform(), norm), found, posed);
    }
    // 7/4 > √3, and the product is rounded up.
    const double wider = std::nextafter(1.75 * distance, HUGE_VAL);
    const auto l2 = toi(posed, distance, Norm::l2), linf = toi(posed, distance, Norm::linf);
    expect_no_later(linf, l2, posed);
    expect_no_later(toi(posed, wider, Norm::l2), linf, posed);
  }
}

}  // namespace
}  // namespace touchstone::exact::distance_oracle_test

#include "exact/distance/distance_oracle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>

#include "tests/support/distance_reference.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::exact::distance_oracle_test {
namespace {

using tests::over_triangle;
using tests::PosedQuery;
using tests::Random;

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

// ---- By itself ------------------------------------------------------------------------------

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

// ---- Relations between distances ----------------------------------------------------------------

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

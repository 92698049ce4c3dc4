#include "verify/fuzz/aligned_roundings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "exact/algebra/number.hpp"
#include "exact/oracle.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::verify::fuzz::aligned_roundings_test {
namespace {

using exact::Rational;

/// The error of a coordinate at time t as solvers compute it.
Rational error_at(double t, double start, double end) {
  const double computed = start * (1.0 - t) + end * t;
  return Rational(computed) - (Rational(start) * (1 - Rational(t)) + Rational(end) * Rational(t));
}

/// The least error by which the computed distance of a's points from b's on that axis at that time
/// is too large, in units of u x.
double worst_case(const Query& query, double t, std::size_t axis) {
  std::array<Rational, moving_points> errors;
  double greatest = 0.0;
  for (std::size_t point = 0; point < moving_points; ++point) {
    const double start = query.at(0, point, axis), end = query.at(1, point, axis);
    errors.at(point) = error_at(t, start, end);
    greatest = std::max({greatest, std::abs(start), std::abs(end)});
  }
  const Rational least = std::min(errors[0], errors[1]) - std::max(errors[2], errors[3]);
  return Rational(least / Rational(greatest * 0x1p-53)).get_d();
}

TEST(Aligned, RoundingsAddUpAtAContact) {
  generate::Random random(3);
  int collisions = 0;
  const int count = tests::trials(200);
  for (int i = 0; i < count; ++i) {
    const Query query = aligned_contact(random);
    const exact::Decision verdict = exact::decide(Kind::edge_edge, query);
    if (!verdict.collides()) continue;
    ++collisions;
    const double toi = verdict.toi->enclosure().lower;
    const double c = toi < 0.5 ? 31.0 / 64 : 33.0 / 64;
    EXPECT_NEAR(toi, c, 1e-12);
    EXPECT_GE(toi, c);
    double worst = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      worst = std::max(worst, worst_case(query, c, axis));
    }
    EXPECT_GT(worst, 3.2);
  }
  EXPECT_GT(collisions, count - count / 50 - 2);
}

}  // namespace
}  // namespace touchstone::verify::fuzz::aligned_roundings_test

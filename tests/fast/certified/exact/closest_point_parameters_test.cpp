#include "fast/certified/exact/closest_point_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/contact_function.hpp"
#include "tests/support/queries.hpp"

namespace touchstone::fast::exact_stage::closest_point_parameters_test {
namespace {

using tests::PosedQuery;
using tests::Random;

/// ‖F(t,u,v)‖, up to rounding.
double distance(const PosedQuery& posed, double t, const Parameters& x, Norm norm) {
  const auto f = tests::contact_function<double>(posed.kind, posed.query, t, x.u, x.v);
  if (norm == Norm::l2) return std::hypot(f[0], f[1], f[2]);
  return std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2])});
}

TEST(NearestParameters, NoOtherPointIsNearer) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Kind kind = i % 2 == 0 ? Kind::vertex_face : Kind::edge_edge;
    const PosedQuery posed = tests::random_query(
        random, kind, tests::all_families[random.bits() % tests::all_families.size()]);
    const double t = random.coin() ? 0.5 : random.uniform();
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const Parameters nearest = nearest_parameters(kind, posed.query, t, norm);
      const double least = distance(posed, t, nearest, norm);
      for (int k = 0; k < 50; ++k) {
        Parameters other{random.uniform(), random.uniform()};
        if (k % 5 == 0) (k % 2 == 0 ? other.u : other.v) = 0.0;
        if (kind == Kind::vertex_face) other.v *= 1.0 - other.u;
        ASSERT_LE(least, distance(posed, t, other, norm) + 1e-7) << posed;
      }
    }
  }
}

TEST(NearestParameters, OverflowsForNoCoordinates) {
  PosedQuery posed = tests::over_triangle(1, 2, 1e-3, 1);
  for (double& x : posed.query.coordinates) x *= 0x1p1020;
  const Parameters x = nearest_parameters(posed.kind, posed.query, 0.0, Norm::l2);
  EXPECT_NEAR(x.u, 0.25, 1e-12);
  EXPECT_NEAR(x.v, 0.5, 1e-12);
}

}  // namespace
}  // namespace touchstone::fast::exact_stage::closest_point_parameters_test

#include "fast/certified/stages/closest_point.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "fast/certified/exact/closest_point_parameters.hpp"
#include "fast/platform/lanes_scalar.hpp"
#include "tests/support/contact_function.hpp"
#include "tests/support/queries.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::kernel::closest_point_test {
namespace {

using Lanes = ScalarLanes;

using Point = Eigen::Vector3d;
template <ContactKind kind>
using Polygon = std::array<Point, kind == ContactKind::vertex_face ? 3 : 4>;

/// The found direction and point, in plain numbers.
struct Found {
  Point direction;
  double u;
  double v;
};

template <ContactKind kind, Norm norm>
Found nearest(const Polygon<kind>& polygon) {
  typename NearestPoint<Lanes, kind, norm>::Corners w;
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      w[i][k] = Lanes::Value(polygon[i][static_cast<Eigen::Index>(k)]);
    }
  }
  const NearestPoint<Lanes, kind, norm> point(w);
  return {{point.direction[0].x, point.direction[1].x, point.direction[2].x}, point.u.x, point.v.x};
}

template <ContactKind kind>
Point point_at(const Polygon<kind>& w, double u, double v) {
  return w[0] + u * (w[1] - w[0]) + v * (w.back() - w[0]);
}

double length(Norm norm, const Point& x) {
  return norm == Norm::l2 ? x.norm() : x.lpNorm<Eigen::Infinity>();
}

double dual_length(Norm norm, const Point& x) {
  return norm == Norm::l2 ? x.norm() : x.lpNorm<1>();
}

/// The distance that the direction separates: at most the true distance, and equal to it for the
/// best direction.
template <ContactKind kind>
double separation(const Polygon<kind>& polygon, const Point& direction) {
  double least = 1e300;
  for (const Point& w : polygon) least = std::min(least, direction.dot(w));
  return least;
}

/// Expects, for a polygon away from the origin, that the direction and the point prove the same
/// distance from both sides.
template <ContactKind kind, Norm norm>
void expect_distance(const Polygon<kind>& polygon, double tolerance) {
  const Found found = nearest<kind, norm>(polygon);
  EXPECT_LE(dual_length(norm, found.direction), unit_length<double>);
  EXPECT_GE(dual_length(norm, found.direction), 1.0 - 1e-12);
  const double least = 0.0 - 1e-12, most = 1.0 + 1e-12;
  EXPECT_TRUE(found.u >= least && found.v >= least && found.u <= most && found.v <= most);
  if (kind == ContactKind::vertex_face) {
    EXPECT_LE(found.u + found.v, most);
  }
  const double below = separation<kind>(polygon, found.direction);
  const double above = length(norm, point_at<kind>(polygon, found.u, found.v));
  EXPECT_GT(below, 0.0);
  EXPECT_NEAR(below, above, tolerance);
}

template <ContactKind kind>
Polygon<kind> random_polygon(tests::Random& random) {
  const auto vector = [&](double size) {
    return Point{random.uniform(-size, size), random.uniform(-size, size),
                 random.uniform(-size, size)};
  };
  Polygon<kind> w;
  // An offset that mostly moves the polygon off the origin.
  const Point offset = vector(2);
  for (std::size_t i = 0; i < 3; ++i) w[i] = offset + vector(1);
  if constexpr (kind == ContactKind::edge_edge) w[3] = w[0] + w[2] - w[1];
  return w;
}

template <ContactKind kind, Norm norm>
void expect_distances_of_random_polygons() {
  tests::Random random(3);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const auto polygon = random_polygon<kind>(random);
    const Found found = nearest<kind, norm>(polygon);
    if (length(norm, point_at<kind>(polygon, found.u, found.v)) < 0.1) continue;
    ++apart;
    expect_distance<kind, norm>(polygon, 1e-12);
  }
  EXPECT_GT(apart, 200);
}

TEST(NearestPoint, DirectionAndPointProveTheSameDistance) {
  expect_distances_of_random_polygons<ContactKind::vertex_face, Norm::l2>();
  expect_distances_of_random_polygons<ContactKind::vertex_face, Norm::linf>();
  expect_distances_of_random_polygons<ContactKind::edge_edge, Norm::l2>();
  expect_distances_of_random_polygons<ContactKind::edge_edge, Norm::linf>();
}

/// Points and segments; and a side that passes the origin at 1e-9: along a direction tilted by
/// rounding its far ends would come nearer.
TEST(NearestPoint, OfPointsSegmentsAndShortDistancesIsFoundToo) {
  const Polygon<ContactKind::vertex_face> point{{{1, 2, 2}, {1, 2, 2}, {1, 2, 2}}};
  expect_distance<ContactKind::vertex_face, Norm::l2>(point, 1e-14);
  expect_distance<ContactKind::vertex_face, Norm::linf>(point, 1e-14);
  const Polygon<ContactKind::edge_edge> segment{{{1, 2, 3}, {2, -1, 3}, {1, 2, 3}, {0, 5, 3}}};
  expect_distance<ContactKind::edge_edge, Norm::l2>(segment, 1e-12);
  expect_distance<ContactKind::edge_edge, Norm::linf>(segment, 1e-12);
  const Polygon<ContactKind::edge_edge> beside{
      {{-1.0 / 3, 1e-9, 0.1}, {2.0 / 3, 1e-9, -0.2}, {2.0 / 3, 1, -0.2}, {-1.0 / 3, 1, 0.1}}};
  expect_distance<ContactKind::edge_edge, Norm::l2>(beside, 1e-15);
}

TEST(NearestPoint, WhatIsNoDirectionSeparatesNothing) {
  const double nan = std::nan("");
  const Polygon<ContactKind::vertex_face> none{{{nan, 0, 0}, {0, nan, 0}, {0, 0, nan}}};
  EXPECT_FALSE(separation<ContactKind::vertex_face>(
                   none, nearest<ContactKind::vertex_face, Norm::l2>(none).direction) < 1e299);
  const Polygon<ContactKind::vertex_face> zero{Point::Zero(), Point::Zero(), Point::Zero()};
  EXPECT_FALSE(
      (nearest<ContactKind::vertex_face, Norm::l2>(zero).direction.array().abs() > 0.0).any());
}

// ---- The exact stage's parameters ---------------------------------------------------------------

/// ‖F(t,u,v)‖, up to rounding.
double distance(const tests::PosedQuery& posed, double t, const exact_stage::Parameters& x,
                Norm norm) {
  const auto f = tests::contact_function<double>(posed.kind, posed.query, t, x.u, x.v);
  if (norm == Norm::l2) return std::hypot(f[0], f[1], f[2]);
  return std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2])});
}

TEST(NearestParameters, NoOtherPointIsNearer) {
  tests::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const ContactKind kind = i % 2 == 0 ? ContactKind::vertex_face : ContactKind::edge_edge;
    const tests::PosedQuery posed = tests::random_query(
        random, kind, tests::all_families[random.bits() % tests::all_families.size()]);
    const double t = random.coin() ? 0.5 : random.uniform();
    for (const Norm norm : {Norm::linf, Norm::l2}) {
      const exact_stage::Parameters nearest =
          exact_stage::nearest_parameters(kind, posed.query, t, norm);
      const double least = distance(posed, t, nearest, norm);
      for (int k = 0; k < 50; ++k) {
        exact_stage::Parameters other{random.uniform(), random.uniform()};
        if (k % 5 == 0) (k % 2 == 0 ? other.u : other.v) = 0.0;
        if (kind == ContactKind::vertex_face) other.v *= 1.0 - other.u;
        ASSERT_LE(least, distance(posed, t, other, norm) + 1e-7) << posed;
      }
    }
  }
}

TEST(NearestParameters, OverflowsForNoCoordinates) {
  tests::PosedQuery posed = tests::over_triangle(1, 2, 1e-3, 1);
  for (double& x : posed.query.coordinates) x *= 0x1p1020;
  const exact_stage::Parameters x =
      exact_stage::nearest_parameters(posed.kind, posed.query, 0.0, Norm::l2);
  EXPECT_NEAR(x.u, 0.25, 1e-12);
  EXPECT_NEAR(x.v, 0.5, 1e-12);
}

}  // namespace
}  // namespace touchstone::fast::kernel::closest_point_test

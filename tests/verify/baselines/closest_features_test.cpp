#include "verify/baselines/closest_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/random.hpp"

namespace touchstone::baselines::closest_features_test {
namespace {

using Vector = Eigen::Vector3d;
using tests::Random;

void expect_both(const Segment& a, const Segment& b, double expected) {
  EXPECT_NEAR(closest_points_squared_distance(a, b), expected, 1e-14 * (1.0 + expected));
  EXPECT_NEAR(feature_squared_distance(a, b), expected, 1e-14 * (1.0 + expected));
}

TEST(SegmentDistance, OfShortSegments) {
  const Segment along_x{{0, 0, 0}, {4, 0, 0}};
  const Segment short_edge{{1, 1e-5, 0}, {1, 9e-5, 0}};
  // A segment of squared length of at most 1e-8 counts by its start; two of them coincide.
  EXPECT_NEAR(closest_points_squared_distance(along_x, {{1, 9e-5, 0}, {1, 1e-5, 0}}), 8.1e-9,
              1e-20);
  EXPECT_NEAR(closest_points_squared_distance({{1, 9e-5, 0}, {1, 1e-5, 0}}, along_x), 8.1e-9,
              1e-20);
  EXPECT_NEAR(closest_points_squared_distance(along_x, short_edge), 1e-10, 1e-20);
  EXPECT_NEAR(closest_points_squared_distance(short_edge, short_edge), 0.0, 0.0);
  EXPECT_NEAR(feature_squared_distance(along_x, {{1, 9e-5, 0}, {1, 1e-5, 0}}), 1e-10, 1e-20);
  expect_both(Segment{{0, 0, 1}, {0, 0, 1}}, {{3, 4, 1}, {3, 4, 1}}, 25.0);
  expect_both(along_x, {{1, 2, 0}, {1, 2, 0}}, 4.0);
}

/// The least squared distance over a grid of points of both, and the error of the grid.
template <class Distance>
double least_on_grid(const Distance& distance, int steps, bool triangle) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= (triangle ? steps - i : steps); ++j) {
      least =
          std::min(least, distance(static_cast<double>(i) / steps, static_cast<double>(j) / steps));
    }
  }
  return least;
}

TEST(Distances, AreTheLeastOnAGridByFeatureAndByPoint) {
  Random random(6);
  constexpr int steps = 60;
  constexpr double off = 4.0 * 2.0 / steps;  // in the distance: two parameters, edges of up to 4
  const auto draw = [&] {
    return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  const auto check = [&](double squared, double on_grid) {
    EXPECT_LE(squared, on_grid + 1e-12);
    EXPECT_LE(std::sqrt(on_grid), std::sqrt(squared) + off);
  };
  for (int i = 0; i < 500; ++i) {
    const Vector p = draw(), a = draw(), b = draw(), c = draw();
    const double to_triangle = least_on_grid(
        [&](double u, double v) { return (p - (a + u * (b - a) + v * (c - a))).squaredNorm(); },
        steps, true);
    const double by_point = closest_point_squared_distance(p, {a, b, c});
    check(by_point, to_triangle);
    EXPECT_NEAR(feature_squared_distance(p, {a, b, c}), by_point, 1e-9);
    const double of_edges = least_on_grid(
        [&](double u, double v) { return (p + u * (a - p) - (b + v * (c - b))).squaredNorm(); },
        steps, false);
    const double by_points = closest_points_squared_distance({p, a}, {b, c});
    check(by_points, of_edges);
    EXPECT_NEAR(feature_squared_distance(Segment{p, a}, {b, c}), by_points, 1e-9);
  }
}

}  // namespace
}  // namespace touchstone::baselines::closest_features_test

/// \file
/// Overlaps in planes of every orientation, degenerate ones too, and the published defect.

#include "verify/baselines/planar_overlap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "exact/contact/triangle_intersection.hpp"
#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::baselines::planar_overlap_test {
namespace {

using Flat = std::array<int, 2>;

/// Places a point of the plane z = 0 in another plane, by an integer matrix of rank 2.
template <class Point>
Point placed(const Flat& p, std::size_t plane) {
  static constexpr std::array<std::array<int, 6>, 4> maps{
      {{1, 0, 0, 1, 0, 0}, {0, 0, 1, 0, 0, 1}, {0, 1, 0, 0, 1, 0}, {2, 1, -1, 3, 1, 1}}};
  const auto& m = maps.at(plane);
  Point point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = m.at(2 * axis) * p[0] + m.at(2 * axis + 1) * p[1];
  }
  return point;
}

PlanarOverlap overlap(const std::array<Flat, 2>& segment, const std::array<Flat, 3>& triangle,
                      std::size_t plane = 0) {
  const auto at = [&](const Flat& p) { return placed<ExactPoint>(p, plane); };
  return planar_overlap({at(segment[0]), at(segment[1])},
                        {at(triangle[0]), at(triangle[1]), at(triangle[2])});
}

/// On small grids most triangles, segments and positions of both are degenerate.
TEST(PlanarOverlap, AgreesWithTheIntersectionInRationals) {
  tests::Random random(1);
  const auto draw = [&] { return Flat{random.between(0, 3), random.between(0, 3)}; };
  int overlapping = 0;
  const int count = tests::trials(4000);
  for (int trial = 0; trial < count; ++trial) {
    const Flat a = draw(), b = random.between(0, 3) == 0 ? a : draw();
    const std::array<Flat, 3> t{draw(), draw(), draw()};
    const std::size_t plane = static_cast<std::size_t>(trial) % 4;
    const auto at = [&](const Flat& p) { return placed<exact::RationalPoint>(p, plane); };
    const bool expected =
        !exact::intersection_of({at(a), at(b), at(b)}, {at(t[0]), at(t[1]), at(t[2])}).empty();
    EXPECT_EQ(overlap({a, b}, t, plane).overlaps, expected);
    overlapping += expected ? 1 : 0;
  }
  EXPECT_GT(overlapping, count / 4);
  EXPECT_LT(overlapping, count / 4 * 3);
}

TEST(PlanarOverlap, DoesNotNoticeACrossingOfTheFirstEdge) {
  // A segment into the edge of points 1 and 2: the weight of point 0 is 0.
  const auto noticed = overlap({{{-2, 4}, {10, 4}}}, {{{8, 0}, {0, 0}, {0, 8}}});
  ASSERT_TRUE(noticed.overlaps);
  EXPECT_EQ(noticed.triangle_weights, (std::array{0.0, 0.5, 0.5}));
  // A segment into the edge of points 0 and 1: the weight of point 2 keeps its initial value.
  const auto unnoticed = overlap({{{-2, 2}, {10, 2}}}, {{{0, 0}, {0, 8}, {8, 0}}});
  ASSERT_TRUE(unnoticed.overlaps);
  EXPECT_EQ(unnoticed.triangle_weights, (std::array{0.75, 0.25, 0.5}));
  EXPECT_NEAR(unnoticed.segment_weights[0], 5.0 / 6.0, 1e-15);
}

}  // namespace
}  // namespace touchstone::baselines::planar_overlap_test

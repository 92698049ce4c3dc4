/// \file
/// Overlaps in planes of every orientation, degenerate ones too, and the published defect.

#include "verify/baselines/planar_overlap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdlib>

#include "tests/support/random.hpp"
#include "tests/support/trials.hpp"

namespace touchstone::baselines::planar_overlap_test {
namespace {

using Flat = std::array<int, 2>;

/// Places a point of the plane z = 0 in another plane, by an integer matrix of rank 2.
ExactPoint placed(const Flat& p, int plane) {
  static constexpr std::array<std::array<int, 6>, 4> maps{
      {{1, 0, 0, 1, 0, 0}, {0, 0, 1, 0, 0, 1}, {0, 1, 0, 0, 1, 0}, {2, 1, -1, 3, 1, 1}}};
  const auto& m = maps.at(static_cast<std::size_t>(plane));
  ExactPoint point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[axis] = ExactNumber(m.at(2 * axis) * p[0] + m.at(2 * axis + 1) * p[1]);
  }
  return point;
}

PlanarOverlap overlap(const std::array<Flat, 2>& segment, const std::array<Flat, 3>& triangle,
                      int plane = 0) {
  return planar_overlap(
      {placed(segment[0], plane), placed(segment[1], plane)},
      {placed(triangle[0], plane), placed(triangle[1], plane), placed(triangle[2], plane)});
}

constexpr std::array<Flat, 3> triangle{{{0, 0}, {8, 0}, {0, 8}}};

TEST(PlanarOverlap, KnowsHowSegmentAndTriangleLie) {
  for (int plane = 0; plane < 4; ++plane) {
    EXPECT_TRUE(overlap({{{1, 1}, {2, 2}}}, triangle, plane).overlaps);    // inside
    EXPECT_TRUE(overlap({{{1, 1}, {9, 9}}}, triangle, plane).overlaps);    // from inside
    EXPECT_TRUE(overlap({{{-1, 3}, {9, 3}}}, triangle, plane).overlaps);   // across
    EXPECT_TRUE(overlap({{{-1, 1}, {1, -1}}}, triangle, plane).overlaps);  // at a corner
    EXPECT_TRUE(overlap({{{4, 4}, {9, 9}}}, triangle, plane).overlaps);    // to an edge
    EXPECT_TRUE(overlap({{{-3, 0}, {0, 0}}}, triangle, plane).overlaps);   // along an edge's line
    EXPECT_FALSE(overlap({{{-3, 0}, {-1, 0}}}, triangle, plane).overlaps);
    EXPECT_FALSE(overlap({{{5, 5}, {9, 9}}}, triangle, plane).overlaps);
    EXPECT_FALSE(overlap({{{-2, 1}, {1, -2}}}, triangle, plane).overlaps);
  }
}

TEST(PlanarOverlap, TakesDegenerateOnes) {
  constexpr std::array<Flat, 3> needle{{{0, 0}, {4, 4}, {2, 2}}}, point{{{1, 1}, {1, 1}, {1, 1}}};
  for (int plane = 0; plane < 4; ++plane) {
    EXPECT_TRUE(overlap({{{1, 1}, {1, 1}}}, triangle, plane).overlaps);
    EXPECT_FALSE(overlap({{{5, 5}, {5, 5}}}, triangle, plane).overlaps);
    EXPECT_TRUE(overlap({{{3, 3}, {3, 3}}}, needle, plane).overlaps);
    EXPECT_FALSE(overlap({{{5, 5}, {5, 5}}}, needle, plane).overlaps);
    EXPECT_FALSE(overlap({{{3, 2}, {3, 2}}}, needle, plane).overlaps);
    EXPECT_TRUE(overlap({{{0, 4}, {4, 0}}}, needle, plane).overlaps);
    EXPECT_TRUE(overlap({{{0, 2}, {2, 0}}}, point, plane).overlaps);
    EXPECT_FALSE(overlap({{{0, 3}, {3, 0}}}, point, plane).overlaps);
    EXPECT_TRUE(overlap({{{1, 1}, {1, 1}}}, point, plane).overlaps);
  }
}

TEST(PlanarOverlap, AgreesWithAllPointsOfSmallGrids) {
  // The weights of lattice points in a triangle are multiples of 1/area.
  tests::Random random(1);
  const auto draw = [&] { return Flat{random.between(0, 3), random.between(0, 3)}; };
  int inside = 0, outside = 0;
  for (int trial = 0; trial < tests::trials(400); ++trial) {
    const std::array<Flat, 3> t{draw(), draw(), draw()};
    const int area = std::abs((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) -
                              (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]));
    if (area == 0) continue;
    const Flat p = draw();
    bool expected = false;
    for (int i = 0; i <= area; ++i) {
      for (int j = 0; i + j <= area; ++j) {
        const int k = area - i - j;
        expected = expected || (i * t[0][0] + j * t[1][0] + k * t[2][0] == area * p[0] &&
                                i * t[0][1] + j * t[1][1] + k * t[2][1] == area * p[1]);
      }
    }
    EXPECT_EQ(overlap({p, p}, t, trial % 4).overlaps, expected);
    ++(expected ? inside : outside);
  }
  EXPECT_GT(inside, tests::trials(40));
  EXPECT_GT(outside, tests::trials(40));
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

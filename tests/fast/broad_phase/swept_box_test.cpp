#include "fast/broad_phase/swept_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "exact/algebra/number.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::swept_box_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr double greatest = std::numeric_limits<double>::max();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

SweptBox cube(double lower, double upper) {
  return {.lower = {lower, lower, lower}, .upper = {upper, upper, upper}};
}

TEST(SweptBox, IsMadeEmpty) {
  const SweptBox box;
  EXPECT_FALSE(box.overlaps(box));
  EXPECT_FALSE(box.overlaps(cube(-greatest, greatest)));
}

TEST(SweptBox, OverlapsBoxesInContactAndNoOthers) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    SweptBox other = cube(0, 1);
    other.lower[axis] = 1;
    other.upper[axis] = 2;
    EXPECT_TRUE(cube(0, 1).overlaps(other) && other.overlaps(cube(0, 1)));
    other.lower[axis] = std::nextafter(1, 2);
    EXPECT_FALSE(cube(0, 1).overlaps(other) || other.overlaps(cube(0, 1)));
  }
}

TEST(SweptBox, IsAroundAllPlacesAtBothTimes) {
  Eigen::MatrixX3d start(3, 3), end(3, 3);
  start << 0, 1, 2, 3, 4, 5, -9, -9, -9;
  end << 1, -1, 2, 3, 4, 7, 9, 9, 9;
  const MovingVertices vertices(start, end);
  EXPECT_EQ(swept_box(vertices, {0, 1, 1}), (SweptBox{.lower = {0, -1, 2}, .upper = {3, 4, 7}}));
  EXPECT_EQ(swept_box(vertices, {0, 0, 0}), (SweptBox{.lower = {0, -1, 2}, .upper = {1, 1, 2}}));
  EXPECT_EQ(swept_box(vertices, {0, 1, 2}), cube(-9, 9));
}

TEST(Widened, IsTheNearestDoubleInsideTheExactSum) {
  Random random(1);
  const auto random_double = [&random] {
    return random.coin() ? random.finite_double() : random.few_bit_double(53, -60, -45);
  };
  for (int i = 0; i < 20'000; ++i) {
    const double bound = random_double(), distance = std::abs(random_double());
    const SweptBox box = widened(cube(bound, bound), distance);
    const Rational exact = Rational(bound) + Rational(distance);
    EXPECT_LE(Rational(box.upper[0]), exact) << bound << ' ' << distance;
    const double next = std::nextafter(box.upper[0], SweptBox::infinity);
    EXPECT_TRUE(std::isinf(next) || Rational(next) > exact) << bound << ' ' << distance;
    EXPECT_EQ(-box.lower[0], widened(cube(-bound, -bound), distance).upper[0]);
    EXPECT_EQ(box, cube(box.lower[0], box.upper[0]));
  }
}

TEST(Widened, HoldsAtTheEndsOfTheRange) {
  EXPECT_EQ(widened(cube(-greatest, greatest), greatest), cube(-greatest, greatest));
  EXPECT_EQ(widened(cube(-greatest, greatest), tiniest), cube(-greatest, greatest));
  EXPECT_EQ(widened(cube(greatest, -greatest), greatest), cube(0, 0));
  EXPECT_EQ(widened(cube(0, 0), tiniest), cube(-tiniest, tiniest));
  EXPECT_EQ(widened(cube(-1, 1), 0), cube(-1, 1));
  EXPECT_EQ(widened(SweptBox{}, greatest), SweptBox{});
}

}  // namespace
}  // namespace touchstone::fast::swept_box_test

#include "exact/rigid/rigid_place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random.hpp"

namespace touchstone::exact {
namespace {

using tests::Random;
using Point = std::array<double, 3>;

RigidMotion turning(const Point& from, const Point& to) {
  return {{.rotation = from}, {.rotation = to}};
}

TEST(RigidPlace, IsThatOfAPlaneRotation) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.uniform(-100, 100), t = random.uniform();
    const Point v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Point x = place_of(turning({}, {0, 0, angle}), v, t);
    const double c = std::cos(t * angle), s = std::sin(t * angle);
    // The product t · angle is rounded.
    constexpr double error = 1e-13;
    EXPECT_NEAR(x[0], c * v[0] - s * v[1], error);
    EXPECT_NEAR(x[1], s * v[0] + c * v[1], error);
    EXPECT_NEAR(x[2], v[2], place_error * 2);
  }
}

TEST(RigidPlace, KeepsDistancesFromTheAxisAndTheOrigin) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto vector = [&](double size) {
      return Point{random.uniform(-size, size), random.uniform(-size, size),
                   random.uniform(-size, size)};
    };
    const double size = std::ldexp(1.0, random.between(-40, 20));
    const Point r = vector(size), v = vector(1.0);
    const Point x = place_of(turning(r, r), v, 0.5);
    const auto dot = [](const Point& a, const Point& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    EXPECT_NEAR(dot(x, x), dot(v, v), 1e-14);
    EXPECT_NEAR(dot(x, r) / size, dot(v, r) / size, 1e-14);
  }
}

TEST(RigidPlace, OfTinyAndOfHugeAngles) {
  const Point v{1, 0, 0};
  EXPECT_EQ(place_of(turning({}, {}), v, 0.5), v);
  EXPECT_EQ(place_of(turning({}, {0, 0, 0x1p-1060}), v, 1.0)[1], 0x1p-1060);
  // sin and cos of 10^22, to many digits.
  const Point x = place_of(turning({}, {0, 0, 1e22}), v, 1.0);
  EXPECT_NEAR(x[0], 0.5232147853951389, 1e-15);
  EXPECT_NEAR(x[1], -0.8522008497671888, 1e-15);
  const RigidMotion moving{{.position = {1, 2, 3}, .rotation = {0, 0, std::numbers::pi}},
                           {.position = {3, 2, 1}, .rotation = {0, 0, -std::numbers::pi}}};
  EXPECT_EQ(place_of(moving, v, 0.5), (Point{3, 2, 2}));
  EXPECT_EQ(place_of(moving, v, 0.5, 2), (Point{0.75, 0.5, 0.5}));
  constexpr double least = 0x1p-1074;
  const RigidMotion tiny = turning({}, {0, 0, std::numbers::pi / 3});
  EXPECT_EQ(place_of(tiny, {least, 0, 0}, 1.0, -1074), place_of(tiny, v, 1.0));
}

}  // namespace
}  // namespace touchstone::exact

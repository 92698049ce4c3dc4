#include "fast/certified/fixed_point_vertices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/faults/planted_faults.hpp"
#include "tests/support/random.hpp"
#include "touchstone/number.hpp"

namespace touchstone::fast::fixed_point_vertices_test {
namespace {

using exact::Rational;
using tests::Random;
using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Coordinates of one size, around an origin, that move by part of it.
Motion scene(Random& random, int exponent, double origin) {
  Places start(20, 3), end(20, 3);
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    start.data()[i] = std::ldexp(origin + random.uniform(-1, 1), exponent);
    end.data()[i] = random.between(0, 3) == 0
                        ? start.data()[i]
                        : std::ldexp(origin + random.uniform(-1, 1), exponent);
  }
  return {start, end};
}

/// The unit by its definition.
double unit_of(const Motion& vertices) {
  double extent = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (const auto& x : {vertices[i].start, vertices[i].end}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        extent = std::max(extent, std::abs(x[axis] - vertices[0].start[axis]));
      }
    }
  }
  return std::ldexp(1.0, std::ilogb(extent) + 1 - 29);
}

/// The greatest error of a whole number, in units. The whole numbers must be small enough.
Rational greatest_error(const Motion& vertices, const FixedPointVertices& rounded, double end) {
  const Rational h(unit_of(vertices)), t(end);
  Rational greatest(0);
  const auto compare = [&](const Rational& x, double origin, std::int32_t whole) {
    EXPECT_LE(std::abs(std::int64_t{whole}), std::int64_t{1} << 29);
    const Rational error = abs(Rational(whole) - (x - Rational(origin)) / h);
    greatest = std::max(greatest, error);
  };
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double origin = vertices[0].start[axis];
      const Rational from(vertices[i].start[axis]), to(vertices[i].end[axis]);
      compare(from, origin, rounded.vertices[i].start[axis]);
      compare(from + t * (to - from), origin, rounded.vertices[i].end[axis]);
    }
  }
  return greatest;
}

/// The first scene whose rounded corners may be farther off than the distance tells, or nothing.
std::string first_fault(decltype(fixed_point_vertices)* rounded_vertices) {
  Random random(1);
  for (const double origin : {0.0, 3.0, 0x1p40, 0x1p60}) {
    for (const double end : {1.0, 0.5, 0x1p-20, 0x1p-40}) {
      for (const double distance : {0.0, 0.125, 1e-9}) {
        const int exponent = random.between(-300, 35);
        const Motion vertices = scene(random, exponent, origin);
        const double scaled = std::ldexp(distance, exponent);
        const FixedPointVertices rounded = rounded_vertices(vertices, end, scaled);
        if (rounded.vertices.data() == nullptr) continue;
        const Rational margin =
            Rational(rounded.distance) - Rational(scaled) / Rational(unit_of(vertices));
        if (margin < 2 * greatest_error(vertices, rounded, end)) {
          return "origin " + std::to_string(origin) + ", end " + std::to_string(end) +
                 ", distance " + std::to_string(distance);
        }
      }
    }
  }
  return "";
}

TEST(FixedPointVertices, AreWithinTheirDistance) {
  EXPECT_EQ(first_fault(fixed_point_vertices), "");
}

TEST(FixedPointVertices, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().fixed_point_vertices) {
    EXPECT_NE(first_fault(fault.part), "") << fault.name;
  }
}

TEST(FixedPointVertices, DistancesAreNotMuchGreaterThanTheirRoundingNeeds) {
  Random random(2);
  const Motion vertices = scene(random, 0, 1.0);
  EXPECT_LT(fixed_point_vertices(vertices, 1.0, 0.0).distance, 1.01F);
  EXPECT_LT(fixed_point_vertices(vertices, 0.25, 0.0).distance, 1.01F);
}

TEST(FixedPointVertices, AreNoneOfScenesThatAreTooLargeOrTooSmall) {
  constexpr double greatest = std::numeric_limits<double>::max();
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const auto has_any = [](double x, double distance) {
    const Places start{{0, 0, 0}, {x, 0, 0}}, end{{0, -x, 0}, {0, 0, 0}};
    return fixed_point_vertices({start, end}, 1.0, distance).vertices.data() != nullptr;
  };
  EXPECT_TRUE(has_any(1.0, 0.0));
  EXPECT_TRUE(has_any(0x1p97, 0.0));
  EXPECT_TRUE(has_any(0x1p-800, 0.0));
  EXPECT_TRUE(has_any(1.0, 0.5));
  EXPECT_FALSE(has_any(0x1p99, 0.0));
  EXPECT_FALSE(has_any(greatest, 0.0));
  EXPECT_FALSE(has_any(least, 0.0));
  EXPECT_FALSE(has_any(0.0, 0.0));
  EXPECT_FALSE(has_any(1.0, 4.0));
  EXPECT_FALSE(has_any(1.0, greatest));
  EXPECT_EQ(fixed_point_vertices({Places(0, 3), Places(0, 3)}, 1.0, 0.0).vertices.data(), nullptr);
}

}  // namespace
}  // namespace touchstone::fast::fixed_point_vertices_test

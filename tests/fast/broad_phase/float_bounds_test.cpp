#include "fast/broad_phase/float_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "exact/algebra/number.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/random.hpp"

namespace touchstone::fast::float_bounds_test {
namespace {

using exact::Rational;
using tests::Random;

constexpr float greatest_float = std::numeric_limits<float>::max();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr double greatest_double = std::numeric_limits<double>::max();
constexpr double tiniest_double = std::numeric_limits<double>::denorm_min();

TEST(FloatAfter, IsTheNextOne) {
  Random random(1);
  std::vector<float> numbers{0.0F,     -0.0F,    1.0F, greatest_float, -greatest_float,
                             infinity, -infinity};
  while (numbers.size() < 10'000) {
    const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(random.bits()));
    if (!std::isnan(x)) numbers.push_back(x);
  }
  for (const float x : numbers) {
    EXPECT_EQ(float_after(x), std::nextafter(x, infinity)) << x;
    EXPECT_EQ(float_before(x), std::nextafter(x, -infinity)) << x;
  }
}

TEST(Rounded, IsTheNearestFloatOnThatSide) {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const double x = i % 3 == 0 ? random.finite_double() : random.few_bit_double(53, -210, 60);
    const float below = rounded_down(x), above = rounded_up(x);
    EXPECT_TRUE(static_cast<double>(below) <= x && static_cast<double>(float_after(below)) > x)
        << x;
    EXPECT_TRUE(static_cast<double>(above) >= x && static_cast<double>(float_before(above)) < x)
        << x;
  }
  EXPECT_EQ(rounded_down(1e300), greatest_float);
  EXPECT_EQ(rounded_up(1e300), infinity);
  EXPECT_EQ(rounded_down(-1e300), -infinity);
  EXPECT_EQ(rounded_up(tiniest_double), std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(rounded_down(static_cast<double>(-infinity)), -infinity);
}

/// Points whose coordinates a function gives.
template <class Coordinate>
Eigen::MatrixX3d places(int count, const Coordinate& coordinate) {
  Eigen::MatrixX3d result(count, 3);
  for (double& x : result.reshaped()) x = coordinate();
  return result;
}

/// Holds the bounds of any two places on any axis against their coordinates.
void expect_ordered_as_coordinates(const Eigen::MatrixX3d& start, const Eigen::MatrixX3d& end) {
  const FloatBounds bounds(MovingVertices(start, end));
  struct Place {
    double x;
    float lower, upper;
  };
  std::vector<Place> all;
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    const VertexBounds& vertex = bounds[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      all.push_back({start(i, axis), vertex.lower[0][axis], vertex.upper[0][axis]});
      all.push_back({end(i, axis), vertex.lower[1][axis], vertex.upper[1][axis]});
    }
  }
  for (const Place& a : all) {
    ASSERT_LE(a.lower, a.upper);
    ASSERT_LE(a.upper, float_after(a.lower));
    ASSERT_LT(std::abs(a.lower), infinity);
    ASSERT_LT(std::abs(a.upper), infinity);
    if (bounds.are_exact()) {
      ASSERT_EQ(a.lower, a.upper);
    }
    for (const Place& b : all) {
      if (a.lower > b.upper) {
        ASSERT_GT(a.x, b.x);
      }
      if (float_after(float_after(a.lower)) <= b.upper) {
        ASSERT_LT(a.x, b.x);
      }
      if (bounds.are_exact()) {
        ASSERT_EQ(a.lower < b.lower, a.x < b.x);
      }
    }
  }
}

TEST(FloatBounds, AreOrderedAsTheCoordinatesAtEveryScale) {
  Random random(3);
  for (const int exponent : {-1074, -1040, -1000, -150, -70, -1, 0, 60, 70, 200, 1000, 1023}) {
    for (const unsigned bits : {3U, 24U, 26U, 53U}) {
      const auto coordinate = [&] {
        const double x =
            random.few_bit_double(bits, -static_cast<int>(bits), -static_cast<int>(bits));
        return std::ldexp(x, random.coin() ? exponent : exponent - random.between(0, 60));
      };
      expect_ordered_as_coordinates(places(12, coordinate), places(12, coordinate));
    }
  }
}

TEST(FloatBounds, AreOrderedAsTheCoordinatesOfAllScalesAtOnce) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const auto coordinate = [&] {
      switch (random.between(0, 5)) {
        case 0:
          return random.coin() ? tiniest_double : -tiniest_double;
        case 1:
          return random.coin() ? greatest_double : -greatest_double;
        case 2:
          return 0.0;
        default:
          return random.finite_double();
      }
    };
    expect_ordered_as_coordinates(places(12, coordinate), places(12, coordinate));
  }
}

std::vector<VertexBounds> bounds_of(const MovingVertices& vertices, double end) {
  const FloatBounds bounds(vertices, end);
  std::vector<VertexBounds> result;
  for (std::size_t i = 0; i < bounds.size(); ++i) result.push_back(bounds[i]);
  return result;
}

/// Are bounds at both ends of [0, time] apart only if the exact places there are? And around these, if the
/// scene is of a usual size?
bool are_around_places(MakeBounds& make, const Eigen::MatrixX3d& start, const Eigen::MatrixX3d& end,
                       double time, bool is_usual) {
  const std::vector<VertexBounds> bounds = make(MovingVertices(start, end), time);
  struct Place {
    Rational x;
    float lower, upper;
  };
  std::vector<Place> all;
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    const VertexBounds& vertex = bounds[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      const Rational from(start(i, axis)), to(end(i, axis));
      all.push_back({from, vertex.lower[0][axis], vertex.upper[0][axis]});
      all.push_back({Rational(from + (to - from) * Rational(time)), vertex.lower[1][axis],
                     vertex.upper[1][axis]});
    }
  }
  return std::ranges::all_of(all, [&](const Place& a) {
    if (a.lower > a.upper) return false;
    if (is_usual && (Rational(a.lower) > a.x || a.x > Rational(a.upper))) return false;
    return std::ranges::all_of(all,
                               [&](const Place& b) { return a.lower <= b.upper || a.x > b.x; });
  });
}

/// What is wrong with such bounds, or nothing.
std::string first_fault(MakeBounds& make) {
  Random random(6);
  for (const double time : {1.0, 0.5, 0x1p-3, 0x1p-20, 0x1p-40, 0x1p-52}) {
    for (const int exponent : {-1074, -1040, -150, -1, 0, 60, 200, 1000, 1022}) {
      for (const unsigned bits : {3U, 24U, 53U}) {
        const auto coordinate = [&] {
          const int size = -static_cast<int>(bits);
          return std::ldexp(random.few_bit_double(bits, size, size),
                            random.coin() ? exponent : exponent - random.between(0, 60));
        };
        if (!are_around_places(make, places(8, coordinate), places(8, coordinate), time,
                               std::abs(exponent) <= 60)) {
          return "coordinates up to 2^" + std::to_string(exponent) + " at " + std::to_string(time);
        }
      }
    }
  }
  // Places near zero of vertices that come from far away: there, floats are nearer to each other than
  // the rounding errors of places are large.
  for (const double time : {0.5, 0x1p-3, 0x1p-20}) {
    const Eigen::MatrixX3d start = places(12, [&] { return random.uniform(-1, 1); });
    if (!are_around_places(make, start, start * (1.0 - 1.0 / time), time, true)) {
      return "places near zero at " + std::to_string(time);
    }
  }
  return "";
}

TEST(FloatBounds, AreAroundThePlacesAtTheEndOfAPart) { EXPECT_EQ(first_fault(bounds_of), ""); }

TEST(FloatBounds, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().float_bounds) {
    EXPECT_NE(first_fault(*fault.part), "") << fault.name;
  }
}

TEST(FloatBounds, OfAPartAreNotWiderThanRoundingNeeds) {
  Random random(7);
  const auto coordinate = [&] { return random.uniform(1, 2); };
  const Eigen::MatrixX3d start = places(200, coordinate), end = places(200, coordinate);
  const FloatBounds bounds(MovingVertices(start, end), 0.25);
  int neighbours = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float lower = bounds[i].lower[1][axis], upper = bounds[i].upper[1][axis];
      EXPECT_LE(upper, float_after(float_after(lower)));
      neighbours += upper == float_after(lower) ? 1 : 0;
    }
  }
  EXPECT_GT(neighbours, 590);
}

TEST(FloatBounds, AreExactForFloats) {
  Random random(5);
  const auto a_float = [&] { return random.few_bit_double(24, -30, 10); };
  Eigen::MatrixX3d start = places(50, a_float);
  const Eigen::MatrixX3d end = places(50, a_float);
  const FloatBounds bounds(MovingVertices(start, end));
  EXPECT_TRUE(bounds.are_exact());
  EXPECT_EQ(static_cast<double>(bounds[7].lower[1][2]), end(7, 2));
  start(49, 1) = 0.1;
  EXPECT_FALSE(FloatBounds(MovingVertices(start, end)).are_exact());
  // A power of two as the scale changes no digit.
  EXPECT_TRUE(FloatBounds(MovingVertices(end * 0x1p-900, end * 0x1p900)).are_exact() ||
              FloatBounds(MovingVertices(end * 0x1p-900, end * 0x1p-900)).are_exact());
  EXPECT_TRUE(FloatBounds(MovingVertices(end * 0x1p900, end * 0x1p900)).are_exact());
  EXPECT_TRUE(FloatBounds(MovingVertices(end * 0.0, end * 0.0)).are_exact());
}

TEST(FloatBounds, ScaleDistancesAsCoordinates) {
  for (const double size : {1.0, 0x1p-1000, 0x1p1000}) {
    const Eigen::MatrixX3d point = Eigen::MatrixX3d::Constant(1, 3, size);
    const FloatBounds bounds(MovingVertices(point, point));
    EXPECT_EQ(bounds.scaled_up(size), bounds[0].upper[0][0]);
    EXPECT_EQ(bounds.scaled_down(size), bounds[0].lower[0][0]);
    EXPECT_LT(bounds.scaled_down(0.1 * size), bounds.scaled_up(0.1 * size));
    EXPECT_GT(bounds.scaled_up(tiniest_double), 0.0F);
    EXPECT_EQ(bounds.scaled_up(0.0), 0.0F);
    EXPECT_LE(bounds.scaled_down(greatest_double), greatest_float);
    EXPECT_GE(bounds.scaled_up(greatest_double), bounds.scaled_down(greatest_double));
  }
}

TEST(FloatBounds, OfNothingAreNone) {
  const Eigen::MatrixX3d none(0, 3);
  EXPECT_EQ(FloatBounds(MovingVertices(none, none)).size(), 0U);
}

}  // namespace
}  // namespace touchstone::fast::float_bounds_test

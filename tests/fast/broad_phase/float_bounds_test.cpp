/// \file
/// The bounds of vertices in float beside exact places, and the groups of primitives.

#include "fast/broad_phase/float_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "fast/broad_phase/primitive_groups.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/random.hpp"
#include "touchstone/number.hpp"

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

/// Points whose coordinates are the values of a function.
template <class Coordinate>
Eigen::MatrixX3d places(int count, const Coordinate& coordinate) {
  Eigen::MatrixX3d result(count, 3);
  for (double& x : result.reshaped()) x = coordinate();
  return result;
}

std::vector<VertexBounds> bounds_of(const Motion& vertices, double end, double distance) {
  const FloatBounds bounds(vertices, end, distance);
  std::vector<VertexBounds> result;
  for (std::size_t i = 0; i < bounds.size(); ++i) result.push_back(bounds[i]);
  return result;
}

/// A coordinate, and its bounds.
struct Place {
  Rational x;
  float lower, upper;
};

/// All coordinates at both ends of [0, time].
std::vector<Place> places_of(const std::vector<VertexBounds>& bounds, const Eigen::MatrixX3d& start,
                             const Eigen::MatrixX3d& end, double time) {
  std::vector<Place> all;
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    const auto& [lower, upper] = bounds[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis) {
      const Rational from(start(i, axis)), to(end(i, axis));
      all.push_back({from, lower[0][axis], upper[0][axis]});
      all.push_back(
          {Rational(from + (to - from) * Rational(time)), lower[1][axis], upper[1][axis]});
    }
  }
  return all;
}

/// True if bounds at both ends of [0, time] are apart only if the exact places there are apart by
/// more than the distance.
bool are_around_places(tests::MakeBounds& make, const Eigen::MatrixX3d& start,
                       const Eigen::MatrixX3d& end, double time, double distance) {
  const std::vector<Place> all =
      places_of(make(Motion(start, end), time, distance), start, end, time);
  return std::ranges::all_of(all, [&](const Place& a) {
    return a.lower <= a.upper && std::ranges::all_of(all, [&](const Place& b) {
             return a.lower <= b.upper || a.x - b.x > Rational(distance);
           });
  });
}

/// Compares the bounds of any two places on any axis with their coordinates: the bounds must
/// overlap if these are within the distance, and surely only then.
void expect_ordered_as_coordinates(const Eigen::MatrixX3d& start, const Eigen::MatrixX3d& end,
                                   double distance) {
  const FloatBounds bounds(Motion(start, end), 1.0, distance);
  EXPECT_TRUE(!bounds.are_exact() || distance == 0.0);
  const std::vector<Place> all =
      places_of(bounds_of(Motion(start, end), 1.0, distance), start, end, 1.0);
  for (const Place& a : all) {
    ASSERT_LE(a.lower, a.upper);
    // The sums of boxes' centres do not overflow.
    ASSERT_LT(std::abs(a.lower), 0x1p100F);
    ASSERT_LT(std::abs(a.upper), 0x1p100F);
    if (distance == 0.0) {
      ASSERT_EQ(a.upper, a.lower);
    }
    for (const Place& b : all) {
      const bool is_near = a.x - b.x <= Rational(distance);
      if (a.lower > b.upper) {
        ASSERT_FALSE(is_near) << a.x << " " << b.x << " " << distance;
      }
      if (a.lower < b.upper || (bounds.are_exact() && a.lower <= b.upper)) {
        ASSERT_TRUE(is_near) << a.x << " " << b.x << " " << distance;
      }
    }
  }
}

TEST(FloatBounds, AreOrderedAsTheCoordinatesOfAllScalesAtOnce) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    // Some values are near a change of rounding: the ends of the window of most coordinates.
    const auto coordinate = [&] {
      const double end = random.coin() ? 0x1p-114 : 0x1p78, any = random.finite_double();
      const double near_end = end * (1.0 + 0x1p-52 * random.between(-2, 2));
      const std::array magnitudes{tiniest_double * random.between(0, 2),
                                  greatest_double,
                                  0.0,
                                  near_end,
                                  near_end,
                                  any,
                                  any,
                                  any};
      const double x = magnitudes.at(static_cast<std::size_t>(random.between(0, 7)));
      return random.coin() ? x : -x;
    };
    const auto usual = [&] { return random.uniform(-1, 1); };
    for (const double distance :
         {0.0, tiniest_double, 3 * tiniest_double, 0.5, 1e300, greatest_double}) {
      expect_ordered_as_coordinates(places(12, coordinate), places(12, coordinate), distance);
      Eigen::MatrixX3d start = places(20, usual);
      start.topRows(8) = places(8, coordinate);
      expect_ordered_as_coordinates(start, places(20, usual), distance);
    }
  }
}

/// The first fault of such bounds, or nothing.
std::string first_fault(tests::MakeBounds& make) {
  Random random(6);
  for (const double time : {1.0, 0.5, 0x1p-3, 0x1p-20, 0x1p-40, 0x1p-52}) {
    for (const int exponent : {-1074, -1040, -150, -1, 0, 60, 200, 1000, 1023}) {
      for (const unsigned bits : {3U, 24U, 53U}) {
        const auto coordinate = [&] {
          const int size = -static_cast<int>(bits);
          return std::ldexp(random.few_bit_double(bits, size, size),
                            random.coin() ? exponent : exponent - random.between(0, 60));
        };
        for (const double distance : {0.0, std::abs(coordinate())}) {
          if (!are_around_places(make, places(8, coordinate), places(8, coordinate), time,
                                 distance)) {
            return "coordinates up to 2^" + std::to_string(exponent) + " at " +
                   std::to_string(time);
          }
        }
      }
    }
    const auto any = [&] { return random.coin() ? random.uniform(-1, 1) : random.finite_double(); };
    if (!are_around_places(make, places(12, any), places(12, any), time, 0.0)) {
      return "coordinates of all sizes at " + std::to_string(time);
    }
  }
  // Places near zero of vertices that come from far away, where the spacing of floats is less than
  // the rounding errors of places; and vertices that rest there.
  for (const double time : {0.5, 0x1p-3, 0x1p-20}) {
    Eigen::MatrixX3d start = places(24, [&] { return random.uniform(-1, 1); });
    Eigen::MatrixX3d end = start * (1.0 - 1.0 / time);
    for (Eigen::Index i = 0; i < 12; ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Rational from(start(i, axis)), to(end(i, axis));
        start(12 + i, axis) = Rational(from + (to - from) * Rational(time)).get_d();
      }
    }
    end.bottomRows(12) = start.bottomRows(12);
    if (!are_around_places(make, start, end, time, 0.0)) {
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
  const FloatBounds bounds(Motion(start, end), 0.25);
  int equal = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float lower = bounds[i].lower[1][axis], upper = bounds[i].upper[1][axis];
      EXPECT_LE(upper, float_after(lower));
      equal += upper == lower ? 1 : 0;
    }
  }
  EXPECT_GT(equal, 590);
}

TEST(FloatBounds, AreExactForFloats) {
  Random random(5);
  const auto a_float = [&] { return random.few_bit_double(24, -30, 10); };
  Eigen::MatrixX3d start = places(50, a_float);
  const Eigen::MatrixX3d end = places(50, a_float);
  const FloatBounds bounds(Motion(start, end));
  EXPECT_TRUE(bounds.are_exact());
  // The window of usual coordinates multiplies by 8.
  EXPECT_EQ(static_cast<double>(bounds[7].lower[1][2]), 8 * end(7, 2));
  start(49, 1) = 0.1;
  EXPECT_FALSE(FloatBounds(Motion(start, end)).are_exact());
  for (const double size : {0x1p-1000, 0x1p-300, 0.0, 0x1p300, 0x1p900}) {
    EXPECT_TRUE(FloatBounds(Motion(end * size, end * size)).are_exact()) << size;
  }
}

// ---- Groups of primitives -----------------------------------------------------------------------

std::vector<std::int32_t> shuffled(int count, Random& random) {
  std::vector<std::int32_t> result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), 0);
  for (std::size_t i = result.size(); i > 1; --i)
    std::swap(result[i - 1], result[random.bits() % i]);
  return result;
}

FloatBounds bounds_at_rest(const Eigen::MatrixX3d& points) {
  return FloatBounds(Motion(points, points));
}

/// Expects each vertex in one place, and repeated in the lanes after the last.
void expect_all_members(const Eigen::MatrixX3d& points, const std::vector<std::int32_t>& vertices) {
  const PrimitiveGroups groups(bounds_at_rest(points), std::span<const std::int32_t>(vertices));
  ASSERT_EQ(groups.size(), vertices.size());
  ASSERT_EQ(groups.members().size(), (vertices.size() + group_size - 1) / group_size);
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < groups.members().size() * group_size; ++i) {
    const GroupMembers& group = groups.members()[i / group_size];
    const std::size_t lane = i % group_size;
    const std::int32_t number = group.numbers[lane];
    if (i >= vertices.size()) {
      EXPECT_EQ(number, numbers.back());
      continue;
    }
    numbers.push_back(number);
    EXPECT_EQ(
        (Primitive{group.vertices[0][lane], group.vertices[1][lane], group.vertices[2][lane]}),
        primitive_of(number));
  }
  std::ranges::sort(numbers);
  EXPECT_EQ(numbers, vertices);
}

TEST(PrimitiveGroups, AreSixteenNeighboursEach) {
  // Points on a line, in any order: a group is sixteen in a row, and groups are in order. The same
  // holds for points whose distances grow without limit: only the rank counts.
  for (const int count : {16, 100, 256, 300, 5000}) {
    for (const bool is_exponential : {false, true}) {
      Random random(7);
      const std::vector<std::int32_t> place = shuffled(count, random);
      Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero(count, 3);
      for (int i = 0; i < count; ++i) {
        points(place[static_cast<std::size_t>(i)], 1) =
            is_exponential ? std::ldexp(1.0, i % 60) * (i / 60 + 1) : i;
      }
      const PrimitiveGroups groups(bounds_at_rest(points), std::span<const std::int32_t>(place));
      double last = 0;
      for (const GroupMembers& group : groups.members()) {
        double first = 1e300, end = 0;
        for (const std::int32_t vertex : group.numbers) {
          first = std::min(first, points(vertex, 1));
          end = std::max(end, points(vertex, 1));
        }
        EXPECT_GE(first, last);
        last = end;
      }
    }
  }
}

TEST(PrimitiveGroups, OfEqualPrimitivesAreAnyAndTakeNoLongerToFind) {
  static constexpr int count = 100'001;
  const Eigen::MatrixX3d points = Eigen::MatrixX3d::Constant(count, 3, 1.0);
  std::vector<std::int32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), 0);
  expect_all_members(points, vertices);
  // Points that are almost all equal, sorted either way.
  for (const double step : {1.0, -1.0}) {
    Eigen::MatrixX3d others = points;
    for (int i = 0; i < count; ++i) others(i, i % 3) += step * (i / 30'000);
    expect_all_members(others, vertices);
  }
}

}  // namespace
}  // namespace touchstone::fast::float_bounds_test

#include "fast/intersections/orientation.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <type_traits>

#include "fast/certified/exact/enclosing_doubles.hpp"
#include "fast/certified/exact/fixed_integer.hpp"

namespace touchstone::fast::meeting {
namespace {

using exact_stage::BigInteger;
using exact_stage::BinaryFraction;
using exact_stage::FixedInteger;
using exact_stage::SignedWideLimb;

// ---- Scale --------------------------------------------------------------------------------------

/// The greatest magnitude of a coordinate.
double greatest_coordinate_of(std::span<const PlaceAtRest> places) {
  double size = 0.0;
  for (const PlaceAtRest& place : places) {
    for (const double x : place) size = std::max(size, std::fabs(x));
  }
  return size;
}

/// True if no coordinate times 2^exponent is rounded.
bool can_be_scaled(std::span<const PlaceAtRest> places, int exponent) {
  return std::ranges::all_of(places, [exponent](const PlaceAtRest& place) {
    return std::ranges::all_of(place, [exponent](double x) {
      return std::ldexp(std::ldexp(x, exponent), -exponent) == x;
    });
  });
}

// ---- Integers -----------------------------------------------------------------------------------

/// The units of some vertices: the exponent of the lowest bit that is set, and the number of bits
/// from there to the highest one.
struct Units {
  int exponent = 0;
  int bits = 0;
};

template <std::size_t points>
using Fractions = std::array<std::array<BinaryFraction, 3>, points>;

template <std::size_t points>
Fractions<points> fractions_of(const Positions& at,
                               const std::array<std::int32_t, points>& vertices) {
  Fractions<points> result;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[i][axis] = exact_stage::odd_fraction(at[vertices[i]][axis]);
    }
  }
  return result;
}

template <std::size_t points>
Units units_of(const Fractions<points>& fractions) {
  int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
  for (const auto& point : fractions) {
    for (const auto& [numerator, exponent] : point) {
      if (numerator == 0) continue;
      const auto magnitude = static_cast<std::uint64_t>(std::abs(numerator));
      lowest = std::min(lowest, exponent);
      highest = std::max(highest, exponent + static_cast<int>(std::bit_width(magnitude)));
    }
  }
  if (lowest > highest) return {};
  return {lowest, highest - lowest};
}

/// The coordinates in the unit. `Number` is std::int64_t, SignedWideLimb or BigInteger.
template <class Number, std::size_t points>
std::array<std::array<Number, 3>, points> scaled(const Fractions<points>& fractions,
                                                 const Units& units) {
  std::array<std::array<Number, 3>, points> result{};
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& [numerator, exponent] = fractions[i][axis];
      if (numerator == 0) continue;
      if constexpr (std::is_same_v<Number, BigInteger>) {
        result[i][axis] = BigInteger(numerator) << (exponent - units.exponent);
      } else {
        result[i][axis] = Number{numerator} * (Number{1} << (exponent - units.exponent));
      }
    }
  }
  return result;
}

/// The component of p × q on an axis.
template <class Vectors>
auto component(const Vectors& p, const Vectors& q, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  return p[u] * q[v] - p[v] * q[u];
}

template <class Vectors>
auto triple(const Vectors& r, const Vectors& p, const Vectors& q) {
  return r[0] * component(p, q, 0) + r[1] * component(p, q, 1) + r[2] * component(p, q, 2);
}

/// to − from, in a type that is multiplied without overflow.
template <class Integer, class Number>
std::array<Integer, 3> between(const std::array<Number, 3>& from, const std::array<Number, 3>& to) {
  return {Integer(to[0] - from[0]), Integer(to[1] - from[1]), Integer(to[2] - from[2])};
}

/// True if the vertices have the same coordinate on an axis.
template <std::size_t points>
bool are_level(const Positions& at, const std::array<std::int32_t, points>& vertices,
               std::size_t axis) {
  const double first = at[vertices[0]][axis];
  return std::ranges::all_of(vertices,
                             [&](std::int32_t vertex) { return at[vertex][axis] == first; });
}

/// sign(points, Integer()) of the points in integers that are long enough for products of three
/// differences: with b bits a difference has b + 1, and the sum of six products 3 (b + 1) + 3.
template <std::size_t points, class Sign>
int sign_in_integers(const Positions& at, const std::array<std::int32_t, points>& vertices,
                     const Sign& sign) {
  const Fractions<points> fractions = fractions_of(at, vertices);
  const Units units = units_of(fractions);
  if (units.bits <= 61) {
    return sign(scaled<std::int64_t>(fractions, units), FixedInteger<1>());
  }
  if (units.bits <= 125) {
    return sign(scaled<SignedWideLimb>(fractions, units), FixedInteger<2>());
  }
  return sign(scaled<BigInteger>(fractions, units), BigInteger());
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

Positions::Positions(const Motion& vertices) : size_(vertices.size()), places_(vertices.size()) {
  for (std::size_t i = 0; i < size_; ++i) places_[i] = vertices[i].start;
  const std::span all(places_.data(), size_);
  static constexpr double least_size = 0x1p-100;
  const double size = greatest_coordinate_of(all);
  if (size <= greatest_coordinate && (size >= least_size || size == 0.0)) return;
  int exponent = 0;
  static_cast<void>(std::frexp(size, &exponent));
  if (can_be_scaled(all, -exponent)) {
    for (PlaceAtRest& place : all) {
      for (double& x : place) x = std::ldexp(x, -exponent);
    }
    exponent_ = exponent;
  } else {
    has_filter_ = size <= greatest_coordinate;
  }
}

std::size_t Normal::greatest_axis() const {
  std::size_t greatest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::fabs(vector[axis]) > std::fabs(vector[greatest])) greatest = axis;
  }
  return greatest;
}

int orientation(const Positions& at, std::int32_t a, std::int32_t b, std::int32_t c,
                std::int32_t d) {
  if (at.has_filter()) {
    const Normal normal(at.difference(a, c), at.difference(a, d));
    const auto [value, bound] = normal.times(at.difference(a, b));
    const int sign = certain_sign(value, bound);
    if (sign != 0) return sign;
  }
  const std::array vertices{a, b, c, d};
  if (are_level(at, vertices, 0) || are_level(at, vertices, 1) || are_level(at, vertices, 2)) {
    return 0;
  }
  return sign_in_integers<4>(at, vertices, [](const auto& x, auto zero) {
    using Integer = decltype(zero);
    return triple(between<Integer>(x[0], x[1]), between<Integer>(x[0], x[2]),
                  between<Integer>(x[0], x[3]))
        .sign();
  });
}

int planar_orientation(const Positions& at, std::size_t axis, std::int32_t a, std::int32_t b,
                       std::int32_t c) {
  if (at.has_filter()) {
    const int sign = Normal(at.difference(a, b), at.difference(a, c)).turn(axis);
    if (sign != 0) return sign;
  }
  const std::array vertices{a, b, c};
  if (are_level(at, vertices, (axis + 1) % 3) || are_level(at, vertices, (axis + 2) % 3)) return 0;
  return sign_in_integers<3>(at, vertices, [axis](const auto& x, auto zero) {
    using Integer = decltype(zero);
    return component(between<Integer>(x[0], x[1]), between<Integer>(x[0], x[2]), axis).sign();
  });
}

bool are_collinear(const Positions& at, std::int32_t a, std::int32_t b, std::int32_t c) {
  if (at.has_filter()) {
    const Normal normal(at.difference(a, b), at.difference(a, c));
    if (normal.turn(0) != 0 || normal.turn(1) != 0 || normal.turn(2) != 0) return false;
  }
  return planar_orientation(at, 0, a, b, c) == 0 && planar_orientation(at, 1, a, b, c) == 0 &&
         planar_orientation(at, 2, a, b, c) == 0;
}

InUnits in_units(const Positions& at, const std::array<std::int32_t, 5>& vertices) {
  const Fractions<5> fractions = fractions_of(at, vertices);
  const Units units = units_of(fractions);
  return {scaled<BigInteger>(fractions, units), units.exponent + at.exponent()};
}

BigInteger determinant(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c,
                       const IntegerPoint& d) {
  return triple(between<BigInteger>(a, b), between<BigInteger>(a, c), between<BigInteger>(a, d));
}

BigInteger determinant(std::size_t axis, const IntegerPoint& a, const IntegerPoint& b,
                       const IntegerPoint& c) {
  return component(between<BigInteger>(a, b), between<BigInteger>(a, c), axis);
}

}  // namespace touchstone::fast::meeting

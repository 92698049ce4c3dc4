#pragma once

/// \file
/// Exact signs of orientations of vertices, for all finite coordinates.
///
/// The determinant is computed in doubles from rounded differences. Its sign is certain beyond the
/// derived bound (touchstone/filters/error_bounds.hpp): of measured_determinant_end in space, of
/// measured_orientation_end in a plane, whose value with the direction of a coordinate axis is one
/// component of a cross product. Otherwise it is computed in integers: the coordinates in units of
/// their lowest bit, which mostly fit into one limb or two, else in integers of any size.
///
/// **Scale.** The bounds hold for coordinates up to `greatest_coordinate`, and few signs are
/// certain among products that underflow. A mesh beyond such sizes is multiplied by a power of two
/// if none of its coordinates is rounded, which changes no sign. If one would be, the mesh remains
/// as it is, and integers alone decide where the bounds do not hold.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fast/certified/exact/big_integer.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/platform/large_array.hpp"
#include "touchstone/filters/error_bounds.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast::meeting {

using Vector = filters::Vector3<double>;

/// Places of vertices at rest.
class Positions {
 public:
  static constexpr double greatest_coordinate = 0x1p100;
  /// A bound of all differences of coordinates.
  static constexpr double greatest_difference = 0x1p102;

  /// \pre the vertices are finite, and at rest; strict floating point.
  explicit Positions(const Motion& vertices);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// The places in the scale of the signs: 2^exponent times these are the given ones.
  [[nodiscard]] const PlaceAtRest* data() const { return places_.data(); }
  [[nodiscard]] int exponent() const { return exponent_; }
  /// False if only integers decide.
  [[nodiscard]] bool has_filter() const { return has_filter_; }

  [[nodiscard]] const PlaceAtRest& operator[](std::int32_t vertex) const {
    return places_[static_cast<std::size_t>(vertex)];
  }
  [[nodiscard]] bool are_equal(std::int32_t a, std::int32_t b) const {
    const auto &x = (*this)[a], &y = (*this)[b];
    return a == b || (x[0] == y[0] && x[1] == y[1] && x[2] == y[2]);
  }
  /// b − a, rounded.
  [[nodiscard]] Vector difference(std::int32_t a, std::int32_t b) const {
    const auto &x = (*this)[a], &y = (*this)[b];
    return {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
  }

 private:
  std::size_t size_;
  LargeArray<PlaceAtRest> places_;
  int exponent_ = 0;
  bool has_filter_ = true;
};

/// The greatest magnitude of the components.
[[nodiscard]] inline double size_of(const Vector& v) {
  const double a = std::fabs(v[0]), b = std::fabs(v[1]), c = std::fabs(v[2]);
  const double ab = a > b ? a : b;
  return ab > c ? ab : c;
}

/// The sign of a number that is computed with an error up to the bound; 0 if it is uncertain.
[[nodiscard]] inline int certain_sign(double x, double bound) {
  return static_cast<int>(x > bound) - static_cast<int>(x < -bound);
}

/// The normal p × q of two rounded differences, with the factors of the bounds of its products with
/// a third difference and of its components.
struct Normal {
  Normal() = default;
  Normal(const Vector& p, const Vector& q)
      : vector(filters::cross(p, q)), size(size_of(p) * size_of(q)) {}

  /// r · N, and the bound of its error.
  struct Product {
    double value, bound;
  };
  [[nodiscard]] Product times(const Vector& r) const {
    constexpr const auto& bound = filters::measured_determinant_end_double;
    constexpr double underflow = bound.underflow(Positions::greatest_difference);
    return {filters::dot(r, vector), bound.rounding() * size * size_of(r) + underflow};
  }
  /// The sign of a component if it is certain, else 0.
  [[nodiscard]] int turn(std::size_t axis) const {
    constexpr const auto& bound = filters::measured_orientation_end_double;
    constexpr double underflow = bound.underflow(Positions::greatest_difference);
    return certain_sign(vector[axis], bound.rounding() * size + underflow);
  }
  /// The axis of the greatest component.
  [[nodiscard]] std::size_t greatest_axis() const;

  Vector vector{};
  double size = 0.0;
};

/// The sign of (b − a) · ((c − a) × (d − a)).
[[nodiscard]] int orientation(const Positions& at, std::int32_t a, std::int32_t b, std::int32_t c,
                              std::int32_t d);

/// The sign of the component of (b − a) × (c − a) on an axis: the orientation of the projection
/// along this axis.
[[nodiscard]] int planar_orientation(const Positions& at, std::size_t axis, std::int32_t a,
                                     std::int32_t b, std::int32_t c);

/// True if three vertices are on a line.
[[nodiscard]] bool are_collinear(const Positions& at, std::int32_t a, std::int32_t b,
                                 std::int32_t c);

using IntegerPoint = std::array<exact_stage::BigInteger, 3>;

/// Places of five vertices as integers in a common unit, 2^exponent.
struct InUnits {
  std::array<IntegerPoint, 5> points;
  int exponent;
};

/// The given places, not the scaled ones.
[[nodiscard]] InUnits in_units(const Positions& at, const std::array<std::int32_t, 5>& vertices);

/// (b − a) · ((c − a) × (d − a)), and the component of (b − a) × (c − a) on an axis.
[[nodiscard]] exact_stage::BigInteger determinant(const IntegerPoint& a, const IntegerPoint& b,
                                                  const IntegerPoint& c, const IntegerPoint& d);
[[nodiscard]] exact_stage::BigInteger determinant(std::size_t axis, const IntegerPoint& a,
                                                  const IntegerPoint& b, const IntegerPoint& c);

}  // namespace touchstone::fast::meeting

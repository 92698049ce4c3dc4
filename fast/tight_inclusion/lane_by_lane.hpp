#pragma once

/// \file
/// The lanes of the kernel (box_kernel_on_lanes.hpp) without vector instructions, for every
/// processor; in float, and for the order of operations of others, in comparisons
/// (verify/published/tight_inclusion.cpp).

#include <cstddef>
#include <limits>

namespace touchstone::fast::lane_by_lane {

/// The bounding box of corner values. `Number` is double or float.
template <class Number>
struct AxisBounds {
  static constexpr std::size_t axes = 3;

  Number least[axes];     // NOLINT(modernize-avoid-c-arrays): no function of another file
  Number greatest[axes];  // NOLINT(modernize-avoid-c-arrays)

  /// True if the box is beyond separation and filter on some axis.
  [[nodiscard]] bool are_beyond(const double* filter, double separation) const {
    const auto d = static_cast<Number>(separation);
    bool result = false;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const auto f = static_cast<Number>(filter[axis]);
      result = result || least[axis] - d > f || greatest[axis] + d < -f;
    }
    return result;
  }

  /// True if the box is within separation and filter on all axes.
  [[nodiscard]] bool are_within(const double* filter, double separation) const {
    const auto d = static_cast<Number>(separation);
    bool result = true;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const auto f = static_cast<Number>(filter[axis]);
      result = result && greatest[axis] - d <= f && least[axis] + d >= -f;
    }
    return result;
  }

  /// The longest side.
  [[nodiscard]] double width() const {
    Number result = 0;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const Number side = greatest[axis] - least[axis];
      result = side > result ? side : result;
    }
    return static_cast<double>(result);
  }
};

/// Eight lanes, one after the other.
template <class Number>
struct Lanes {
  static constexpr int digits = std::numeric_limits<Number>::digits;
  static constexpr std::size_t size = 8;
  static constexpr std::size_t half = 4;

  Number lane[size];  // NOLINT(modernize-avoid-c-arrays): no function of another file

  static Number rounded(double x) { return static_cast<Number>(x); }
  static Lanes twice(double a, double b, double c, double d) {
    return {{rounded(a), rounded(b), rounded(c), rounded(d), rounded(a), rounded(b), rounded(c),
             rounded(d)}};
  }
  static Lanes twice(const double* four) { return twice(four[0], four[1], four[2], four[3]); }
  static Lanes halves(double a, double b) {
    return {{rounded(a), rounded(a), rounded(a), rounded(a), rounded(b), rounded(b), rounded(b),
             rounded(b)}};
  }
  template <std::size_t axis>
  static Lanes coordinate(const double* points) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = rounded(points[3 * i + axis]);
    return result;
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] + b.lane[i];
    return result;
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] - b.lane[i];
    return result;
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    Lanes result;
    for (std::size_t i = 0; i < size; ++i) result.lane[i] = a.lane[i] * b.lane[i];
    return result;
  }

  template <int a, int b, int c, int d>
  [[nodiscard]] Lanes shuffled() const {
    return {{lane[a], lane[b], lane[c], lane[d], lane[half + a], lane[half + b], lane[half + c],
             lane[half + d]}};
  }

  void store(double* values) const {
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<double>(lane[i]);
  }

  [[nodiscard]] bool are_finite() const {
    bool result = true;
    for (const Number x : lane) result = result && x - x == 0;
    return result;
  }
  [[nodiscard]] Number least() const {
    Number result = lane[0];
    for (const Number x : lane) result = x < result ? x : result;
    return result;
  }
  [[nodiscard]] Number greatest() const {
    Number result = lane[0];
    for (const Number x : lane) result = x > result ? x : result;
    return result;
  }
  [[nodiscard]] double magnitude() const {
    const Number lower = -least(), upper = greatest();
    return static_cast<double>(upper > lower ? upper : lower);
  }

  static AxisBounds<Number> bounds(const Lanes& x, const Lanes& y, const Lanes& z) {
    return {{x.least(), y.least(), z.least()}, {x.greatest(), y.greatest(), z.greatest()}};
  }
};

}  // namespace touchstone::fast::lane_by_lane

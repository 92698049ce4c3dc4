#pragma once

/// \file
/// Stage 2, direction (docs/theory.md, section 6.3).
///
/// **Theorem.** Let d be a fixed direction and n ≥ ‖d‖*, its dual norm. If d·w_i > D n for all
/// corners w_i at t=0 and at t=1, where D is the minimum separation or 0, there is no contact: each
/// d·w_i is linear in t, so it is always greater than D n.
///
/// d is the sum of the corners. If any fixed direction has positive products with all corners, so
/// has the point nearest to the origin of the convex hull of all corners at both ends. Further
/// directions approach it: from the mean of the corners, each goes towards the corner with the
/// least d·w, to the nearest point on the way. The computed values have to exceed the error bound
/// of their expression (filters::ProjectedGap, filters::AdvancedGap).

#include <array>
#include <cstddef>
#include <limits>

#include "fast/certified/stages/lanes.hpp"

namespace touchstone::fast::kernel {

/// A query's points as differences from one of them, at t=0 and t=1. The corners are all a − b for
/// a of the first and b of the second list.
template <class Value, ContactKind kind>
struct Differences {
  static constexpr std::size_t firsts = kind == ContactKind::vertex_face ? 1 : 2;
  static constexpr std::size_t seconds = kind == ContactKind::vertex_face ? 2 : 1;

  std::array<std::array<Vector<Value>, 2>, firsts> a;
  std::array<std::array<Vector<Value>, 2>, seconds> b;  ///< with the origin, which is a b too

  template <class Coordinate>
  explicit Differences(const std::array<Vector<Coordinate>, query_points>& x) {
    constexpr std::size_t origin = kind == ContactKind::vertex_face ? 1 : 2;
    for (std::size_t end = 0; end < 2; ++end) {
      const Vector<Coordinate>& from = x[4 * end + origin];
      for (std::size_t i = 0; i < firsts; ++i) a[i][end] = minus(x[4 * end + i], from);
      for (std::size_t i = 0; i < seconds; ++i) {
        b[i][end] = minus(x[4 * end + origin + 1 + i], from);
      }
    }
  }

  /// The sum of the corners, up to a factor.
  [[nodiscard]] Vector<Value> sum_of_corners() const {
    Vector<Value> sum;
    for (std::size_t k = 0; k < 3; ++k) {
      if constexpr (kind == ContactKind::vertex_face) {
        const Value of_a = a[0][0][k] + a[0][1][k];
        sum[k] = ((of_a + of_a) + of_a) - ((b[0][0][k] + b[0][1][k]) + (b[1][0][k] + b[1][1][k]));
      } else {
        sum[k] =
            ((a[0][0][k] + a[0][1][k]) + (a[1][0][k] + a[1][1][k])) - (b[0][0][k] + b[0][1][k]);
      }
    }
    return sum;
  }

  /// The greatest magnitude of a coordinate.
  [[nodiscard]] Value magnitude() const {
    Value result = kernel::magnitude(a[0]);
    for (std::size_t i = 1; i < firsts; ++i) result = max(result, kernel::magnitude(a[i]));
    for (std::size_t i = 0; i < seconds; ++i) result = max(result, kernel::magnitude(b[i]));
    return result;
  }

  /// A corner with the least d·w at both ends, and that product.
  struct Least {
    Value gap;
    Vector<Value> corner;
  };

  [[nodiscard]] Least least(const Vector<Value>& d) const {
    std::array<Least, 2> of_end;
    for (std::size_t end = 0; end < 2; ++end) {
      Vector<Value> first = a[0][end], second{Value(0), Value(0), Value(0)};
      Value least_a = filters::dot(d, first), greatest_b(0);
      for (std::size_t i = 1; i < firsts; ++i) {
        const Value of_a = filters::dot(d, a[i][end]);
        first = chosen(of_a < least_a, a[i][end], first);
        least_a = min(least_a, of_a);
      }
      for (std::size_t i = 0; i < seconds; ++i) {
        const Value of_b = filters::dot(d, b[i][end]);
        second = chosen(of_b > greatest_b, b[i][end], second);
        greatest_b = max(greatest_b, of_b);
      }
      of_end[end] = {least_a - greatest_b, minus(first, second)};
    }
    return {min(of_end[0].gap, of_end[1].gap),
            chosen(of_end[1].gap < of_end[0].gap, of_end[1].corner, of_end[0].corner)};
  }

 private:
  static Vector<Value> chosen(const MaskOf<Value>& mask, const Vector<Value>& x,
                              const Vector<Value>& y) {
    return {select(mask, x[0], y[0]), select(mask, x[1], y[1]), select(mask, x[2], y[2])};
  }
};

/// \tparam steps The number of further directions.
template <class Value, bool separated, ContactKind kind, int steps = 0>
class DirectionTest {
 public:
  MaskOf<Value> bounded;  ///< the query is small enough for all bounds, and finite
  MaskOf<Value> apart;    ///< no contact, if it is bounded

  template <class Coordinate>
  DirectionTest(const std::array<Vector<Coordinate>, query_points>& points, const Value& distance) {
    const Differences<Value, kind> differences(points);
    const Value magnitude = differences.magnitude();
    Vector<Value> d = differences.sum_of_corners();
    bounded = (max(magnitude, distance) <= Value(limits.distance)) & is_number(d);
    apart = MaskOf<Value>::none();
    for (int step = 0; step < steps; ++step) {
      const auto least = differences.least(d);
      apart = apart | separates(d, least.gap, magnitude, distance);
      constexpr auto of_sum = Scalar(1) / Scalar(kind == ContactKind::vertex_face ? 6 : 4);
      if (step == 0) d = {d[0] * Value(of_sum), d[1] * Value(of_sum), d[2] * Value(of_sum)};
      approach(d, least.corner);
    }
    apart = apart | separates(d, differences.least(d).gap, magnitude, distance);
  }

 private:
  using Scalar = typename Value::Scalar;
  using Format = FormatOf<Value>;
  static constexpr Limits<Scalar> limits = Format::limits;

  /// Moves a point to the one nearest to the origin on the way to a corner.
  static void approach(Vector<Value>& point, const Vector<Value>& corner) {
    const Vector<Value> way = minus(corner, point);
    const Value square = max(filters::dot(way, way), Value(Format::least_length));
    const Value part = (Value(0) - filters::dot(point, way)) / square;
    const Value part_of_way = max(min(part, Value(1)), Value(0));
    for (std::size_t k = 0; k < 3; ++k) point[k] = point[k] + part_of_way * way[k];
  }

  /// \param gap The least d·w, at both ends.
  static MaskOf<Value> separates(const Vector<Value>& d, const Value& gap, const Value& magnitude,
                                 const Value& distance) {
    if constexpr (separated) {
      return separates_by(d, gap, magnitude, distance);
    } else {
      const Value bound = greatest(d) * magnitude * Value(Format::projected_gap.rounding()) +
                          Value(Format::projected_gap.underflow(limits.direction));
      return gap > bound;
    }
  }

  /// The test with a distance: d·w − D n as filters::AdvancedGap. n is the sum of the magnitudes of
  /// d's components, rounded up, an upper bound of both norms.
  static MaskOf<Value> separates_by(const Vector<Value>& d, const Value& gap,
                                    const Value& magnitude, const Value& distance) {
    constexpr Scalar above_rounding = 1 + 4 * std::numeric_limits<Scalar>::epsilon();
    const Value n = (abs(d[0]) + abs(d[1]) + abs(d[2])) * Value(above_rounding);
    const Value bound = n * max(magnitude, distance) * Value(Format::advanced_gap.rounding()) +
                        Value(Format::advanced_gap.underflow(limits.direction));
    return gap - n * distance > bound;
  }

  /// True if the sum of the corners is finite, and hence each coordinate, which is a term of it.
  static MaskOf<Value> is_number(const Vector<Value>& sum) {
    const Value zero(0);
    const Value difference = ((sum[0] - sum[0]) + (sum[1] - sum[1])) + (sum[2] - sum[2]);
    return difference <= zero;
  }
};

}  // namespace touchstone::fast::kernel

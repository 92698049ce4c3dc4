#pragma once

/// \file
/// The moving polygon P(t) = conv{w_i(t)} of a query with a minimum separation D > 0, in
/// lanes, and a condition for no contact (docs/theory.md, section 6.10).
///
/// **Theorem.** Let c_a and c_b be directions of dual norm at most n. For s from 0 at a to 1 at b,
/// c = (1−s) c_a + s c_b has a dual norm of at most n, and c·w_i − D n is quadratic with the
/// Bernstein coefficients
///
///     c_a·w_i(a) − D n,    ½ ((c_a·w_i(b) − D n) + (c_b·w_i(a) − D n)),    c_b·w_i(b) − D n.
///
/// If they are positive for all corners, each point of P is always farther away than D: there is no
/// contact in [a,b].
///
/// With the best directions at a and at b the condition is nearly sharp, because the middle
/// coefficient accounts for the rotation in between.

#include <array>
#include <cstddef>

#include "fast/certified/stages/closest_point.hpp"
#include "fast/certified/stages/direction.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::fast::kernel {

/// The input of MovingPolygon: the first primitive's points, then the second's, as differences from
/// the second's first point, which is omitted; each at t=0 and t=1.
template <class Value, ContactKind kind>
struct PolygonVectors {
  std::array<std::array<Vector<Value>, 2>, 3> vectors;
  Value magnitude;  ///< greatest of their coordinates

  template <class Coordinate>
  explicit PolygonVectors(const std::array<Vector<Coordinate>, query_points>& points) {
    const Differences<Value, kind> of_points(points);
    std::size_t place = 0;
    for (const auto& a : of_points.a) vectors[place++] = a;
    for (const auto& b : of_points.b) vectors[place++] = b;
    magnitude = of_points.magnitude();
  }
};

/// The moving corners and their proved properties.
template <class Lanes, ContactKind kind, Norm norm>
class MovingPolygon {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Scalar = typename Value::Scalar;
  using Format = FormatOf<Value>;
  using Vector = std::array<Value, 3>;
  using Nearest = NearestPoint<Lanes, kind, norm>;
  static constexpr std::size_t corners = Nearest::corners;
  /// Rounded differences of points, whose differences are the corners.
  static constexpr std::size_t differences = 3;
  static constexpr std::size_t rows = 6 * differences;

  /// \param points As in PolygonVectors.
  /// \param magnitude The greatest of their coordinates.
  MovingPolygon(const std::array<std::array<Vector, 2>, differences>& points,
                const Value& magnitude, Scalar distance)
      : points_(points),
        gap_(Value(unit_length<Scalar>) * Value(distance)),
        bound_(Value(unit_length<Scalar>) * max(magnitude, Value(distance)) *
                   Value(Format::advanced_gap.rounding()) +
               Value(Format::advanced_gap.underflow(Format::limits.difference))) {}

  /// The corners at a time.
  [[nodiscard]] typename Nearest::Corners corners_at(const Value& time) const {
    std::array<Vector, differences> at;
    for (std::size_t i = 0; i < differences; ++i) {
      at[i] = filters::at_time(points_[i][0], points_[i][1], Value(1) - time, time);
    }
    typename Nearest::Corners w;
    for (std::size_t k = 0; k < corners; ++k) {
      const auto [first, second] = points_of(k);
      w[k] = at[first];
      if (second == differences) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) w[k][axis] = at[first][axis] - at[second][axis];
    }
    return w;
  }

  /// c·w of each corner at t=0 and t=1, for a direction c.
  struct Projections {
    std::array<Value, corners> start;
    std::array<Value, corners> end;

    /// The value at the point with these parameters.
    [[nodiscard]] static Value at_point(const std::array<Value, corners>& of_corners,
                                        const Value& u, const Value& v) {
      const Value& origin = of_corners[0];
      return origin + (of_corners[1] - origin) * u + (of_corners[corners - 1] - origin) * v;
    }
  };

  [[nodiscard]] Projections project(const Vector& c) const {
    std::array<std::array<Value, differences>, 2> of_points;
    for (std::size_t i = 0; i < differences; ++i) {
      of_points[0][i] = filters::dot(c, points_[i][0]);
      of_points[1][i] = filters::dot(c, points_[i][1]);
    }
    Projections result;
    for (std::size_t k = 0; k < corners; ++k) {
      const auto [first, second] = points_of(k);
      const bool is_origin = second == differences;
      result.start[k] =
          is_origin ? of_points[0][first] : of_points[0][first] - of_points[0][second];
      result.end[k] = is_origin ? of_points[1][first] : of_points[1][first] - of_points[1][second];
    }
    return result;
  }

  /// c·w − D n of a corner at a time, as filters::AdvancedGap.
  [[nodiscard]] Value gap(const Projections& c, std::size_t corner, const Value& time) const {
    return filters::blend(c.start[corner], c.end[corner], Value(1) - time, time) - gap_;
  }

  /// An upper bound of the error of gap() if 1 − time is exact. Twice the bound also covers the
  /// rounding of 1 − time: at most 2^-54 of the start, which is at most 6 times the product of the
  /// magnitudes.
  [[nodiscard]] const Value& bound() const { return bound_; }

  /// The lanes in which the first two coefficients on [a,b] are positive for all corners. `weight`
  /// is 1 if 1−b is exact, else 2.
  [[nodiscard]] Mask begins_apart(const Projections& c_a, const Projections& c_b, const Value& a,
                                  const Value& b, Scalar weight) const {
    const Value enough = bound_ * Value(Scalar(2.001) * weight);
    Mask result = Mask::all();
    for (std::size_t k = 0; k < corners; ++k) {
      result = result & (gap(c_a, k, a) > bound_) & (gap(c_a, k, b) + gap(c_b, k, a) > enough);
    }
    return result;
  }

  /// The lanes in which the last coefficient on [a,b] is positive for all corners.
  [[nodiscard]] Mask ends_apart(const Projections& c_b, const Value& b) const {
    Mask result = Mask::all();
    for (std::size_t k = 0; k < corners; ++k) result = result & (gap(c_b, k, b) > bound_);
    return result;
  }

  /// The contact as Newton's method predicts it from the closest point at a time.
  struct Prediction {
    Value gap;     ///< to the distance D, at the time
    Value time;    ///< predicted time of contact
    Mask is_near;  ///< the polygon approaches
  };

  [[nodiscard]] Prediction predict(const Projections& c, const Value& u, const Value& v,
                                   const Value& time) const {
    const Value start = Projections::at_point(c.start, u, v);
    const Value end = Projections::at_point(c.end, u, v);
    const Value now = filters::blend(start, end, Value(1) - time, time) - gap_;
    const Value rate = start - end;
    return {now, time + now / rate, rate > Value(0)};
  }

 private:
  /// The indices of the two differences whose difference is the corner; the second is `differences`
  /// if the corner equals the first.
  static constexpr std::array<std::size_t, 2> points_of(std::size_t corner) {
    if constexpr (kind == ContactKind::vertex_face) {
      constexpr std::array<std::array<std::size_t, 2>, 3> all{{{0, 3}, {0, 1}, {0, 2}}};
      return all[corner];
    } else {
      constexpr std::array<std::array<std::size_t, 2>, 4> all{{{0, 3}, {1, 3}, {1, 2}, {0, 2}}};
      return all[corner];
    }
  }

  std::array<std::array<Vector, 2>, differences> points_;
  Value gap_;  ///< D n
  Value bound_;
};

}  // namespace touchstone::fast::kernel

#pragma once

/// \file
/// The stage of the certified solver for a minimum separation D > 0 that is large beside rounding: it
/// follows the moving polygon P(t) = conv{w_i(t)} from t=0 on, in lanes.
///
/// **No contact in [a,b].** Let c_a and c_b be directions of dual norm at most n. For s from 0 at a to 1
/// at b, c = (1−s) c_a + s c_b has a dual norm of at most n, and c·w_i − D n is quadratic with the
/// Bernstein coefficients
///
///     c_a·w_i(a) − D n,    ½ ((c_a·w_i(b) − D n) + (c_b·w_i(a) − D n)),    c_b·w_i(b) − D n.
///
/// If they are positive for all corners, each point of P is farther away than D, all the time. With the
/// directions that are best at a and at b, little is lost: the middle coefficient knows of the turn in
/// between. So steps can be nearly as long as the way to the contact, which Newton's method predicts
/// from the nearest point's velocity.
///
/// **Contact at b.** Some (u,v) of the domain with ‖F(b,u,v)‖ ≤ D: the nearest point's parameters.
///
/// The time of impact is enclosed by the two: no contact in [0,lower], contact at upper. They are so
/// near to each other that the last coefficient and F need double-double.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/certified/stages/closest_point.hpp"
#include "filters/double_double.hpp"

namespace touchstone::fast {

/// Where the corners are while they move, and what is proved of that.
template <class Lanes, Kind kind, Norm norm>
class MovingPolygon {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Vector = std::array<Value, 3>;
  using Nearest = NearestPoint<Lanes, kind, norm>;
  static constexpr std::size_t corners = Nearest::corners;
  /// Differences of points, rounded: what corners are differences of.
  static constexpr std::size_t differences = 3;
  static constexpr std::size_t rows = 6 * differences;

  /// \param differences The first primitive's points, then the second's, as differences from the
  /// second's first point, which is left out; each at t=0 and t=1.
  /// \param magnitude Of their coordinates.
  MovingPolygon(const std::array<std::array<Vector, 2>, differences>& points,
                const Value& magnitude, double distance)
      : points_(points),
        gap_(Value(unit_length) * Value(distance)),
        bound_(Value(unit_length) * max(magnitude, Value(distance)) *
                   Value(filters::measured_advanced_gap_double.rounding()) +
               Value(filters::measured_advanced_gap_double.underflow(greatest_size))) {}

  /// The corners at a time.
  [[nodiscard]] typename Nearest::Corners corners_at(const Value& time) const {
    std::array<Vector, differences> at;
    for (std::size_t i = 0; i < differences; ++i) {
      at[i] = filters::at_time(points_[i][0], points_[i][1], Value(1.0) - time, time);
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

    /// At the point with these parameters.
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
    return filters::blend(c.start[corner], c.end[corner], Value(1.0) - time, time) - gap_;
  }

  /// What the error of gap() stays below if 1 − time is exact; twice it also covers its rounding, by
  /// at most 2^-54 of the start, which is itself at most 6 times the product of the magnitudes.
  [[nodiscard]] const Value& bound() const { return bound_; }

  /// Are the first two coefficients on [a,b] positive, for all corners? `weight` is 1 if 1−b is exact,
  /// else 2.
  [[nodiscard]] Mask begins_apart(const Projections& c_a, const Projections& c_b, const Value& a,
                                  const Value& b, double weight) const {
    const Value enough = bound_ * Value(2.001 * weight);
    Mask result = Mask::all();
    for (std::size_t k = 0; k < corners; ++k) {
      result = result & (gap(c_a, k, a) > bound_) & (gap(c_a, k, b) + gap(c_b, k, a) > enough);
    }
    return result;
  }

  /// And the last?
  [[nodiscard]] Mask ends_apart(const Projections& c_b, const Value& b) const {
    Mask result = Mask::all();
    for (std::size_t k = 0; k < corners; ++k) result = result & (gap(c_b, k, b) > bound_);
    return result;
  }

  /// Where Newton's method sees the contact from a time, by the nearest point there.
  struct Prediction {
    Value gap;     ///< to the distance D, at the time
    Value time;    ///< of contact
    Mask is_near;  ///< it comes nearer
  };

  [[nodiscard]] Prediction predict(const Projections& c, const Value& u, const Value& v,
                                   const Value& time) const {
    const Value start = Projections::at_point(c.start, u, v);
    const Value end = Projections::at_point(c.end, u, v);
    const Value now = filters::blend(start, end, Value(1.0) - time, time) - gap_;
    const Value rate = start - end;
    return {now, time + now / rate, rate > Value(0.0)};
  }

  /// Sizes are below this: the stage takes queries whose points are nearer to each other.
  static constexpr double greatest_size = 0x1p102;

 private:
  /// The differences whose difference a corner is; the second may be none.
  static constexpr std::array<std::size_t, 2> points_of(std::size_t corner) {
    if constexpr (kind == Kind::vertex_face) {
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

/// What is proved in double-double, of the points themselves.
template <class Lanes, Kind kind, Norm norm>
class PreciseProof {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Vector = std::array<Value, 3>;
  using Precise = filters::DoubleDouble<Value>;

  /// \param magnitude Of all differences of points.
  PreciseProof(const std::array<Vector, query_points>& points, const Value& magnitude,
               double distance)
      : magnitude_(max(magnitude, Value(distance))), points_(points), distance_(distance) {}

  /// D.
  [[nodiscard]] Value distance() const { return Value(distance_); }

  /// The least c·w − D n of all corners at a time, less its bound.
  [[nodiscard]] Value least_gap(const Vector& c, const Value& time) const {
    const Value bound = magnitude_ * Value(unit_length * gap_bound.rounding()) +
                        Value(gap_bound.underflow(greatest_size));
    const std::array<Precise, 2> weights{filters::exact_difference(Value(1.0), time), exact(time)};
    Value least(0x1p1000);
    for (const Corner& corner : corner_points) {
      const std::size_t plus = corner.plus, minus = corner.minus;
      std::array<Precise, filters::AdvancedGap::coordinates> x;
      x.fill(exact(Value(0.0)));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = exact(c[axis]);
        x[4 + axis] = filters::exact_difference(points_[plus][axis], points_[minus][axis]);
        x[10 + axis] = filters::exact_difference(points_[4 + plus][axis], points_[4 + minus][axis]);
      }
      x[3] = exact(Value(unit_length));
      x[16] = exact(Value(distance_));
      least = min(least, filters::AdvancedGap::evaluate<Precise>(x, weights).high);
    }
    return least - bound * Value(1.001);
  }

  /// Is ‖F(time,u,v)‖ ≤ D? \pre (u,v) is in the domain.
  [[nodiscard]] Mask is_within(const Value& time, const Value& u, const Value& v) const {
    const std::array<Precise, 4> weights{filters::exact_difference(Value(1.0), time), exact(time),
                                         exact(u), exact(v)};
    const Value error = magnitude_ * Value(1.001 * component_bound.rounding()) +
                        Value(component_bound.underflow(greatest_size));
    std::array<Precise, 3> x;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x[axis] = filters::ContactComponent::evaluate<Precise>(coordinates(axis), weights);
    }
    if constexpr (norm == Norm::l2) return is_short(x, error);
    Mask result = Mask::all();
    for (const Precise& component : x) {
      const Mask is_negative = component.high < Value(0.0);
      const Precise zero = exact(Value(0.0)), mirrored = zero - component;
      const Precise size{select(is_negative, mirrored.high, component.high),
                         select(is_negative, mirrored.low, component.low)};
      // The sum of pairs is as right as its own size asks.
      result = result & ((exact(Value(distance_)) - size).high > error);
    }
    return result;
  }

 private:
  static constexpr auto gap_bound = filters::advanced_gap_double_double;
  static constexpr auto component_bound = filters::contact_component_double_double;
  static constexpr auto defect_bound = filters::length_defect_double_double;
  static constexpr double greatest_size = 0x1p104;

  static constexpr std::span<const Corner> corner_points = touchstone::corners(kind);
  static constexpr std::size_t corners = corner_points.size();
  /// r, p, q of filters/polynomial_expressions.hpp.
  static constexpr auto vectors = affine_vectors(kind);

  static Precise exact(const Value& x) { return {x, Value(0.0)}; }

  /// ContactComponent's, with D = 0.
  [[nodiscard]] std::array<Precise, 7> coordinates(std::size_t axis) const {
    std::array<Precise, 7> x;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [plus, minus] = vectors[i];
      x[i] = filters::exact_difference(points_[plus][axis], points_[minus][axis]);
      x[3 + i] = filters::exact_difference(points_[4 + plus][axis], points_[4 + minus][axis]);
    }
    x[6] = exact(Value(0.0));
    return x;
  }

  /// x is wrong by at most `error` on each axis, y the truth. If D² − |x|² ≥ 4 D error + 4 error², then
  /// |x| ≤ D and |y| ≤ |x| + √3 error, so that |y|² ≤ |x|² + 2√3 D error + 3 error² ≤ D².
  [[nodiscard]] Mask is_short(const std::array<Precise, 3>& x, const Value& error) const {
    const Value size =
        max(max(abs(x[0].high), abs(x[1].high)), max(abs(x[2].high), Value(distance_)));
    const Value bound = size * size * Value(1.001 * defect_bound.rounding()) +
                        Value(defect_bound.underflow(greatest_size)) +
                        Value(4.01) * error * (Value(distance_) + error);
    const Value defect =
        filters::LengthDefect::evaluate<Precise>({x[0], x[1], x[2], exact(Value(distance_))}, {})
            .high;
    return defect > bound;
  }

  Value magnitude_;
  const std::array<Vector, query_points>& points_;
  double distance_;
};

}  // namespace touchstone::fast

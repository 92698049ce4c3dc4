#pragma once

/// \file
/// The point of a polygon that is closest to the origin, and the direction that separates
/// them best, in lanes. It is an approximation: the users of a direction or a point bound its
/// effect.
///
/// In L2 the nearest point x is inside the polygon, on a side or at a corner, and its direction is
/// N or x itself. (The direction for a side e is x − (x·e) e/|e|²: if x is short, rounding would
/// tilt x against the side, and the far end would appear much closer.)
///
/// In L∞ the directions are the facet normals of the Minkowski sum of the cube and the mirrored
/// polygon: coordinate axes, N, and e_k × e for the axes e_k and sides e. The one with the greatest
/// distance is chosen. It determines the contact of the polygon with a cube around the origin: of a
/// corner of the polygon with a face of the cube, of its interior with a corner of the cube, or of
/// a side with an edge of the cube.

#include <array>
#include <cstddef>
#include <limits>

#include "fast/certified/stages/lanes.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/filters/separation_expressions.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::kernel {

/// The maximum dual norm of scaled directions: 1, with a margin for the rounding of the scaling.
template <class Scalar>
inline constexpr Scalar unit_length = 1 + 4 * std::numeric_limits<Scalar>::epsilon();

template <class Lanes, ContactKind kind, Norm norm>
class NearestPoint {
 public:
  using Value = typename Lanes::Value;
  using Mask = typename Lanes::Mask;
  using Vector = std::array<Value, 3>;
  static constexpr std::size_t corners = kind == ContactKind::vertex_face ? 3 : 4;
  using Corners = std::array<Vector, corners>;

  /// The direction, of dual norm at most unit_length; NaN if none separates.
  Vector direction{};
  /// Parameters of the point, in F's domain up to rounding.
  Value u = Value(0);
  Value v = Value(0);

  /// \param w The corners in cyclic order.
  explicit NearestPoint(const Corners& w) {
    if constexpr (norm == Norm::l2) {
      search_l2(w);
    } else {
      search_linf(w);
    }
    scale();
  }

 private:
  using Scalar = typename Value::Scalar;
  using Format = FormatOf<Value>;
  static constexpr std::size_t last = corners - 1;

  static Vector plus_multiple(const Vector& a, const Vector& b, const Value& factor) {
    return {a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor};
  }
  static Vector chosen(const Mask& mask, const Vector& a, const Vector& b) {
    return {select(mask, a[0], b[0]), select(mask, a[1], b[1]), select(mask, a[2], b[2])};
  }
  static Value negative(const Value& x) { return Value(0) - x; }
  static Value with_sign(const Value& magnitude, const Value& sign) {
    return select(sign < Value(0), negative(magnitude), magnitude);
  }

  /// (u,v) of a corner.
  static constexpr std::array<Scalar, 2> parameters(std::size_t corner) {
    if constexpr (kind == ContactKind::vertex_face) {
      constexpr std::array<std::array<Scalar, 2>, 3> all{{{0, 0}, {1, 0}, {0, 1}}};
      return all[corner];
    } else {
      constexpr std::array<std::array<Scalar, 2>, 4> all{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
      return all[corner];
    }
  }

  /// Takes a point of the side i, j in the lanes of `is_better`.
  void take_on_side(const Mask& is_better, std::size_t i, std::size_t j, const Value& part) {
    const auto from = parameters(i), to = parameters(j);
    u = select(is_better, Value(from[0]) + Value(to[0] - from[0]) * part, u);
    v = select(is_better, Value(from[1]) + Value(to[1] - from[1]) * part, v);
  }

  /// Divides the direction by an upper bound of its dual norm.
  void scale() {
    const Value most = greatest(direction);
    Value length(0);
    if constexpr (norm == Norm::l2) {
      constexpr auto bound = Format::squared_length;
      const auto square = filters::SquaredLength::evaluate<Value>(direction, {});
      length = sqrt(square + (most * most * Value(bound.rounding()) +
                              Value(bound.underflow(Format::limits.direction))));
    } else {
      constexpr auto bound = Format::component_sum;
      const auto sum = filters::ComponentSum::evaluate<Value>(
          {abs(direction[0]), abs(direction[1]), abs(direction[2])}, {});
      length =
          sum + (most * Value(bound.rounding()) + Value(bound.underflow(Format::limits.direction)));
    }
    // A direction that is too long for the bound, too short to divide by, or NaN becomes 0, which
    // separates nothing.
    const Mask is_sound =
        (most <= Value(Format::limits.direction)) & (length >= Value(Format::least_length));
    const Value factor = select(is_sound, Value(1) / length, Value(0));
    for (Value& x : direction) x = x * factor;
  }

  // ---- L2 ----

  void search_l2(const Corners& w) {
    Value least(std::numeric_limits<Scalar>::max());
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t j = (i + 1) % corners;
      const Vector e = minus(w[j], w[i]);
      const Value square = filters::dot(e, e), reach = negative(filters::dot(w[i], e));
      const Value part =
          select(square > Value(0), max(min(reach / square, Value(1)), Value(0)), Value(0));
      const Vector x = plus_multiple(w[i], e, part);
      const Value distance = filters::dot(x, x);
      const Mask is_better = distance < least;
      const Mask is_inside = (part > Value(0)) & (part < Value(1));
      const Vector upright = plus_multiple(x, e, negative(filters::dot(x, e)) / square);
      least = select(is_better, distance, least);
      direction = chosen(is_better, chosen(is_inside, upright, x), direction);
      take_on_side(is_better, i, j, part);
    }
    search_inside(w);
  }

  /// The lanes in which the origin's projection is in the polygon.
  void search_inside(const Corners& w) {
    const Vector n = filters::cross(minus(w[1], w[0]), minus(w[last], w[0]));
    const Value square = filters::dot(n, n), zero(0);
    std::array<Value, corners> turns;
    Mask is_inside = square > zero;
    for (std::size_t i = 0; i < corners; ++i) {
      turns[i] = filters::dot(n, filters::cross(w[i], w[(i + 1) % corners]));
      is_inside = is_inside & (turns[i] >= zero);
    }
    const Value height = filters::dot(n, w[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Value outward = select(height < zero, negative(n[k]), n[k]);
      direction[k] = select(is_inside, outward, direction[k]);
    }
    u = select(is_inside, turns[last] / square, u);
    v = select(is_inside, turns[0] / square, v);
  }

  // ---- L∞ ----

  void search_linf(const Corners& w) {
    // The best direction's distance times length, and its length.
    Value gap(-1), length(0);
    const auto is_better = [&](const Value& other_gap, const Value& other_length) {
      const Mask better = other_gap * length > gap * other_length;
      gap = select(better, other_gap, gap);
      length = select(better, other_length, length);
      return better;
    };
    length = Value(Format::least_length);
    for (std::size_t axis = 0; axis < 3; ++axis) try_axis(w, axis, is_better);
    const std::size_t directions = kind == ContactKind::vertex_face ? 3 : 2;
    for (std::size_t i = 0; i < directions; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) try_side(w, i, axis, is_better);
    }
    try_normal(w, is_better);
  }

  template <class IsBetter>
  void try_axis(const Corners& w, std::size_t axis, const IsBetter& is_better) {
    for (const Scalar sign : {Scalar(1), Scalar(-1)}) {
      Value least = Value(sign) * w[0][axis], least_u(0), least_v(0);
      for (std::size_t i = 1; i < corners; ++i) {
        const Value x = Value(sign) * w[i][axis];
        const Mask less = x < least;
        const auto [corner_u, corner_v] = parameters(i);
        least = select(less, x, least);
        least_u = select(less, Value(corner_u), least_u);
        least_v = select(less, Value(corner_v), least_v);
      }
      const Mask better = is_better(least, Value(1));
      Vector d{Value(0), Value(0), Value(0)};
      d[axis] = Value(sign);
      direction = chosen(better, d, direction);
      u = select(better, least_u, u);
      v = select(better, least_v, v);
    }
  }

  /// The direction e_axis × e for a side e from corner i, and for the opposite side of a
  /// parallelogram.
  template <class IsBetter>
  void try_side(const Corners& w, std::size_t i, std::size_t axis, const IsBetter& is_better) {
    const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3, j = (i + 1) % corners;
    const std::size_t from = (j + 1) % corners;
    const std::size_t to = kind == ContactKind::vertex_face ? from : (i + 3) % corners;
    const Value e_y = w[j][y] - w[i][y], e_z = w[j][z] - w[i][z];
    const auto project = [&](std::size_t corner) {
      return e_y * w[corner][z] - e_z * w[corner][y];
    };
    const Value here = project(i), there = project(from);
    const Value zero(0);
    const Mask is_above = min(here, there) > zero;
    const Value gap = select(is_above, min(here, there), negative(max(here, there)));
    const Value length = abs(e_y) + abs(e_z);
    const Mask better = is_better(gap, length) & (length > zero);
    Vector d{zero, zero, zero};
    d[y] = select(is_above, negative(e_z), e_z);
    d[z] = select(is_above, e_y, negative(e_y));
    direction = chosen(better, d, direction);
    // The closer side, and its point on the cube's edge.
    const Mask is_here = abs(here) <= abs(there);
    const Value start_y = select(is_here, w[i][y], w[to][y]);
    const Value start_z = select(is_here, w[i][z], w[to][z]);
    const Value reach = gap / length;
    const Value part_y = (with_sign(reach, d[y]) - start_y) / e_y;
    const Value part_z = (with_sign(reach, d[z]) - start_z) / e_z;
    const Value part = max(min(select(abs(e_y) > abs(e_z), part_y, part_z), Value(1)), zero);
    take_on_side(better & is_here, i, j, part);
    if constexpr (kind == ContactKind::edge_edge) {
      const Mask is_there = abs(there) < abs(here);
      take_on_side(better & is_there, to, from, part);
    }
  }

  template <class IsBetter>
  void try_normal(const Corners& w, const IsBetter& is_better) {
    const Vector n = filters::cross(minus(w[1], w[0]), minus(w[last], w[0]));
    const Value height = filters::dot(n, w[0]);
    const Value length = (abs(n[0]) + abs(n[1])) + abs(n[2]), zero(0);
    const Mask better = is_better(abs(height), length) & (length > zero);
    Vector d, at_cube;
    const Value reach = abs(height) / length;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = select(height < zero, negative(n[k]), n[k]);
      at_cube[k] = with_sign(reach, d[k]);
    }
    direction = chosen(better, d, direction);
    const Vector first = minus(w[0], at_cube);
    const Value square = filters::dot(n, n);
    u = select(better, filters::dot(n, filters::cross(minus(w[last], at_cube), first)) / square, u);
    v = select(better, filters::dot(n, filters::cross(first, minus(w[1], at_cube))) / square, v);
  }
};

}  // namespace touchstone::fast::kernel

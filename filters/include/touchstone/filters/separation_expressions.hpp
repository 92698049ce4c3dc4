#pragma once

/// \file
/// The filtered expressions of the certified solver with a minimum separation D > 0. (Rules
/// for expressions: touchstone/filters/expressions.hpp; vectors and steps:
/// touchstone/filters/polynomial_expressions.hpp.)
///
/// A fixed direction d keeps a moving corner w = a − b more than D away from the origin, in a norm
/// whose dual norm of d is at most n, if d·w > D n. The gap d·w − D n is linear in time: if it is
/// positive at two times, it is positive between them. Conversely, a point x of the polygon with
/// ‖x‖ ≤ D at one time proves a contact.

#include <array>
#include <cstddef>
#include <string_view>

#include "touchstone/filters/polynomial_expressions.hpp"

namespace touchstone::filters {

/// x for x ∈ [0,1].
inline constexpr Group<2, 1> unit_interval{{{0}, {1}}};

/// d·(a − b) − D n, a and b moving, at a time t. Coordinates: d, n, then a, b at t=0, a, b at t=1,
/// D. Weights: (1−t, t).
struct AdvancedGap : ExpressionInputs<17, unit_segment> {
  static constexpr std::string_view name = "advanced_gap";
  static constexpr std::array<std::size_t, coordinates> classes{0, 0, 0, 0, 1, 1, 1, 1, 1,
                                                                1, 1, 1, 1, 1, 1, 1, 1};

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const Vector3<Scalar> d = vector_of<0>(x);
    const Scalar start = dot(d, vector_of<4>(x)) - dot(d, vector_of<7>(x));
    const Scalar end = dot(d, vector_of<10>(x)) - dot(d, vector_of<13>(x));
    return blend(start, end, w[0], w[1]) - x[3] * x[16];
  }
};

/// The gap of rounded differences a and b.
struct MeasuredAdvancedGap : Measured<AdvancedGap> {
  static constexpr std::string_view name = "measured_advanced_gap";
};

/// d·w − D n: the same of a corner w. Coordinates: d, n, w, D.
struct CornerGap : ExpressionInputs<8> {
  static constexpr std::string_view name = "corner_gap";
  static constexpr std::array<std::size_t, coordinates> classes{0, 0, 0, 0, 1, 1, 1, 1};

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*w*/) {
    return dot(vector_of<0>(x), vector_of<4>(x)) - x[3] * x[7];
  }
};

/// x + y + z: the L1 norm of a vector with the magnitudes x, y, z, dual to L∞.
struct ComponentSum : ExpressionInputs<3> {
  static constexpr std::string_view name = "component_sum";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*w*/) {
    return (x[0] + x[1]) + x[2];
  }
};

/// x·x, the square of the L2 norm, dual to itself.
struct SquaredLength : ExpressionInputs<3> {
  static constexpr std::string_view name = "squared_length";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*w*/) {
    return dot(x, x);
  }
};

/// D² − x·x. Coordinates: x, D.
struct LengthDefect : ExpressionInputs<4> {
  static constexpr std::string_view name = "length_defect";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*w*/) {
    const Vector3<Scalar> vector = vector_of<0>(x);
    return x[3] * x[3] - dot(vector, vector);
  }
};

/// One axis of F = r − u p − v q at (t,u,v), beyond D: F − D. Coordinates: r, p, q at t=0, then at
/// t=1, D. Weights: (1−t, t), u, v.
struct ContactComponent : ExpressionInputs<7, unit_segment, unit_interval, unit_interval> {
  static constexpr std::string_view name = "contact_component";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto at_time = [&](std::size_t i) { return blend(x[i], x[3 + i], w[0], w[1]); };
    return ((at_time(0) - at_time(1) * w[2]) - at_time(2) * w[3]) - x[6];
  }
};

}  // namespace touchstone::filters

#pragma once

/// \file
/// The filtered expressions of the certified solver: polynomials in t by their Bernstein
/// coefficients. (Rules for expressions: touchstone/filters/expressions.hpp.)
///
/// Both kinds of query are written F = r − u p − v q, each of r, p, q moving linearly:
///
///     vertex_face:  r = v − f0,    p = f1 − f0,    q = f2 − f0
///     edge_edge:    r = ea0 − eb0, p = ea0 − ea1,  q = eb1 − eb0
///
/// On an interval [a,b] of times a polynomial of degree n is in the hull of its Bernstein
/// coefficients; the first and the last are its values at a and b. For products of linearly moving
/// vectors the coefficients are averages of products of the vectors' values at a and b (the
/// blossom):
///
///     N = p × q:        N_a = p_a × q_a,     2 N_ab = p_a × q_b + p_b × q_a,     N_b
///     det = r · N:      r_a·N_a,   (r_b·N_a + r_a·2N_ab) / 3,   (r_a·N_b + r_b·2N_ab) / 3, r_b·N_b
///     x · (d × y):      x_a·(d×y_a),   (x_a·(d×y_b) + x_b·(d×y_a)) / 2,    x_b·(d×y_b)
///
/// for a fixed direction d. The steps below compute them without the divisors. The last
/// coefficients are the first ones with a and b exchanged, so that one expression serves both.
///
/// The vectors are *differences of coordinates*, rounded once: their components are the
/// expressions' coordinates, each in the class of its vector, and `Measured` adds their rounding.

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "touchstone/filters/expressions.hpp"

namespace touchstone::filters {

template <class Scalar>
using Vector3 = std::array<Scalar, 3>;

// ---- Steps --------------------------------------------------------------------------------------

template <class Scalar>
[[nodiscard]] constexpr Vector3<Scalar> add(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class Scalar>
[[nodiscard]] constexpr Scalar dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

template <class Scalar>
[[nodiscard]] constexpr Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A moving vector at a time, given by its weights 1−t and t.
template <class Scalar>
[[nodiscard]] constexpr Vector3<Scalar> at_time(const Vector3<Scalar>& start,
                                                const Vector3<Scalar>& end,
                                                const Scalar& weight_start,
                                                const Scalar& weight_end) {
  return {blend(start[0], end[0], weight_start, weight_end),
          blend(start[1], end[1], weight_start, weight_end),
          blend(start[2], end[2], weight_start, weight_end)};
}

/// Twice the middle Bernstein coefficient of p × q.
template <class Scalar>
[[nodiscard]] constexpr Vector3<Scalar> normal_middle(const Vector3<Scalar>& p_a,
                                                      const Vector3<Scalar>& p_b,
                                                      const Vector3<Scalar>& q_a,
                                                      const Vector3<Scalar>& q_b) {
  return add(cross(p_a, q_b), cross(p_b, q_a));
}

/// Three times the second Bernstein coefficient of r · N, from N_a and 2 N_ab. With a and b
/// exchanged, the third.
template <class Scalar>
[[nodiscard]] constexpr Scalar determinant_middle(const Vector3<Scalar>& r_a,
                                                  const Vector3<Scalar>& r_b,
                                                  const Vector3<Scalar>& n_a,
                                                  const Vector3<Scalar>& twice_n_ab) {
  return dot(r_b, n_a) + dot(r_a, twice_n_ab);
}

/// Twice the middle Bernstein coefficient of x · (d × y), from d × y_a and d × y_b.
template <class Scalar>
[[nodiscard]] constexpr Scalar orientation_middle(const Vector3<Scalar>& x_a,
                                                  const Vector3<Scalar>& x_b,
                                                  const Vector3<Scalar>& d_y_a,
                                                  const Vector3<Scalar>& d_y_b) {
  return dot(x_a, d_y_b) + dot(x_b, d_y_a);
}

// ---- Expressions --------------------------------------------------------------------------------

/// Three consecutive coordinates.
template <std::size_t first, class Scalar, std::size_t count>
[[nodiscard]] constexpr Vector3<Scalar> vector_of(const std::array<Scalar, count>& x) {
  return {x[first], x[first + 1], x[first + 2]};
}

/// The moving vector whose start and end begin at the given coordinates, at the time whose weights
/// begin at the given one.
template <std::size_t start, std::size_t end, std::size_t weight, class Scalar, std::size_t count,
          std::size_t weights>
[[nodiscard]] constexpr Vector3<Scalar> moving_vector(const std::array<Scalar, count>& x,
                                                      const std::array<Scalar, weights>& w) {
  return at_time(vector_of<start>(x), vector_of<end>(x), w[weight], w[weight + 1]);
}

/// d·a − d·b: the distance by which a is beyond b in a fixed direction d. Coordinates: d, a, b.
struct ProjectedGap : ExpressionInputs<9> {
  static constexpr std::string_view name = "projected_gap";
  static constexpr std::array<std::size_t, coordinates> classes{0, 0, 0, 1, 1, 1, 1, 1, 1};

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& /*w*/) {
    const Vector3<Scalar> d = vector_of<0>(x);
    return dot(d, vector_of<3>(x)) - dot(d, vector_of<6>(x));
  }
};

/// Inputs whose weights are (1−t, t) for so many times t.
template <class Coordinates, std::size_t times>
struct AtTimes : Coordinates {
  static constexpr std::size_t weights = 2 * times;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    for (std::size_t i = 0; i < times; ++i) visit(unit_segment);
  }
};

/// Common parts of the two expressions of the determinant. Coordinates: r, p, q at t=0, then at
/// t=1.
struct DeterminantInputs {
  static constexpr std::size_t coordinates = 18;
  static constexpr std::array<std::size_t, coordinates> classes{0, 0, 0, 1, 1, 1, 2, 2, 2,
                                                                0, 0, 0, 1, 1, 1, 2, 2, 2};
};

/// r · (p × q) at a time t. Weights: (1−t, t) of r, of p and of q. (The code uses one t. The
/// theorem needs separate groups, so the bound holds for three.)
struct DeterminantEnd : AtTimes<DeterminantInputs, 3> {
  static constexpr std::string_view name = "determinant_end";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return dot(moving_vector<0, 9, 0>(x, w),
               cross(moving_vector<3, 12, 2>(x, w), moving_vector<6, 15, 4>(x, w)));
  }
};

/// Three times the second Bernstein coefficient of det on [a,b]. Weights: (1−a, a), (1−b, b) of r,
/// of p and of q.
struct DeterminantMiddle : AtTimes<DeterminantInputs, 6> {
  static constexpr std::string_view name = "determinant_middle";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const auto r_a = moving_vector<0, 9, 0>(x, w), r_b = moving_vector<0, 9, 2>(x, w);
    const auto p_a = moving_vector<3, 12, 4>(x, w), p_b = moving_vector<3, 12, 6>(x, w);
    const auto q_a = moving_vector<6, 15, 8>(x, w), q_b = moving_vector<6, 15, 10>(x, w);
    return determinant_middle(r_a, r_b, cross(p_a, q_a), normal_middle(p_a, p_b, q_a, q_b));
  }
};

/// Common parts of the two expressions of an orientation. Coordinates: d, then x, y at t=0, then at
/// t=1.
struct OrientationInputs {
  static constexpr std::size_t coordinates = 15;
  static constexpr std::array<std::size_t, coordinates> classes{0, 0, 0, 1, 1, 1, 2, 2,
                                                                2, 1, 1, 1, 2, 2, 2};
};

/// x · (d × y) at a time t, for a fixed direction d. Weights: (1−t, t) of x and of y.
struct OrientationEnd : AtTimes<OrientationInputs, 2> {
  static constexpr std::string_view name = "orientation_end";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return dot(moving_vector<3, 9, 0>(x, w), cross(vector_of<0>(x), moving_vector<6, 12, 2>(x, w)));
  }
};

/// Twice the middle Bernstein coefficient of x · (d × y) on [a,b]. Weights: (1−a, a), (1−b, b) of x
/// and of y.
struct OrientationMiddle : AtTimes<OrientationInputs, 4> {
  static constexpr std::string_view name = "orientation_middle";

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    const Vector3<Scalar> d = vector_of<0>(x);
    return orientation_middle(moving_vector<3, 9, 0>(x, w), moving_vector<3, 9, 2>(x, w),
                              cross(d, moving_vector<6, 12, 4>(x, w)),
                              cross(d, moving_vector<6, 12, 6>(x, w)));
  }
};

// ---- Rounded coordinates ------------------------------------------------------------------------

/// The expression with each coordinate rounded once, as for differences of given numbers: the
/// computed coordinate is x (1+δ), the exact one x. In the model of the derivation that is a
/// product with an added weight that is 1. Solvers run the expression itself on the rounded
/// coordinates.
template <class Expression>
struct Measured {
  static constexpr std::size_t coordinates = Expression::coordinates;
  static constexpr std::size_t weights = Expression::weights + coordinates;
  static constexpr std::array<std::size_t, coordinates> classes = Expression::classes;

  template <class Visitor>
  static constexpr void visit_groups(const Visitor& visit) {
    Expression::visit_groups(visit);
    for (std::size_t i = 0; i < coordinates; ++i) visit(one);
  }

  template <class Scalar>
  [[nodiscard]] static constexpr Scalar evaluate(const std::array<Scalar, coordinates>& x,
                                                 const std::array<Scalar, weights>& w) {
    return evaluate_rounded(x, w, std::make_index_sequence<coordinates>(),
                            std::make_index_sequence<Expression::weights>());
  }

 private:
  static constexpr Group<1, 1> one{{{1}}};

  template <class Scalar, std::size_t... i, std::size_t... j>
  static constexpr Scalar evaluate_rounded(const std::array<Scalar, coordinates>& x,
                                           const std::array<Scalar, weights>& w,
                                           std::index_sequence<i...> /*coordinates*/,
                                           std::index_sequence<j...> /*weights*/) {
    return Expression::evaluate(
        std::array<Scalar, coordinates>{x[i] * w[Expression::weights + i]...},
        std::array<Scalar, Expression::weights>{w[j]...});
  }
};

struct MeasuredProjectedGap : Measured<ProjectedGap> {
  static constexpr std::string_view name = "measured_projected_gap";
};
struct MeasuredDeterminantEnd : Measured<DeterminantEnd> {
  static constexpr std::string_view name = "measured_determinant_end";
};
struct MeasuredDeterminantMiddle : Measured<DeterminantMiddle> {
  static constexpr std::string_view name = "measured_determinant_middle";
};
struct MeasuredOrientationEnd : Measured<OrientationEnd> {
  static constexpr std::string_view name = "measured_orientation_end";
};
struct MeasuredOrientationMiddle : Measured<OrientationMiddle> {
  static constexpr std::string_view name = "measured_orientation_middle";
};

}  // namespace touchstone::filters

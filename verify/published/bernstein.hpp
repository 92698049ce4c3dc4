#pragma once

/// \file
/// The Bernstein forms that TCCD [wang2015] and BSC [tang2014] share, over any number type.
///
/// Four points a, b, c, d move on straight lines: the face and the vertex, or the edges ab and cd.
///   - *Coplanarity*, a cubic Y: Y(t) = 0 where they lie in a plane.
///   - *Inside*, three quartics G_i: at a root of Y there is contact iff all are ≥ 0.
///
/// **Theorem (reduction).** Let k be Y's coefficients. Then `reduce` gives a quadratic J that has,
/// at every root of Y in (0,1], the sign of G: J = 4 k_0² G · c/t² there, c > 0. Proof: subtract
/// from G a multiple of Y so that the value at t = 0 vanishes, divide by t, and do the same again.
/// ∎ It says nothing where k_0 = 0.
///
/// **Theorem (decomposition).** For J quadratic there are linear L and K with T·Y = L·J + K, T =
/// (2j_1 − j_0 − j_2)² ≥ 0: polynomial division with remainder. At a root of Y, therefore, J has
/// the sign of −K/L; and at a root of J, Y has that of K.
///
/// A number type has a constructor from int, +, − and *, and a function half.
///
/// Forms are arrays of coefficients over Bernstein's polynomials of their degree. The scale of a
/// form is any positive number (those of Y are three times the usual ones), except where two are
/// added.

#include <array>
#include <cstddef>

#include "touchstone/query.hpp"

namespace touchstone::verify::published {

/// The functions of the number types, for doubles.
[[nodiscard]] inline double half(double x) { return 0.5 * x; }

template <class Number>
using Vector = std::array<Number, 3>;
/// Bernstein coefficients of a form of that degree.
template <class Number, std::size_t degree>
using Bernstein = std::array<Number, degree + 1>;

template <class Number>
[[nodiscard]] Vector<Number> operator+(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class Number>
[[nodiscard]] Vector<Number> operator-(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
[[nodiscard]] Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Number>
[[nodiscard]] Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A point or vector that moves linearly: at t=0 and at t=1.
template <class Number>
using Moving = std::array<Vector<Number>, 2>;
/// The points a, b, c, d.
template <class Number>
using MovingPoints = std::array<Moving<Number>, 4>;

/// The points of a query: its coordinates in the order of Query, as numbers.
template <class Number>
[[nodiscard]] MovingPoints<Number> moving_points_of(
    ContactKind kind, const std::array<Number, 3 * query_points>& coordinates) {
  constexpr std::array<std::size_t, 4> face_then_vertex{1, 2, 3, 0}, edges{0, 1, 2, 3};
  const auto& order = kind == ContactKind::vertex_face ? face_then_vertex : edges;
  MovingPoints<Number> points;
  for (std::size_t i = 0; i < moving_points; ++i) {
    for (std::size_t end = 0; end < 2; ++end) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        points[i][end][axis] = coordinates[3 * (moving_points * end + order[i]) + axis];
      }
    }
  }
  return points;
}

/// The same for number types with a constructor from double.
template <class Number>
[[nodiscard]] MovingPoints<Number> moving_points_of(ContactKind kind, const Query& query) {
  std::array<Number, 3 * query_points> coordinates;
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] = query.coordinates[i];
  return moving_points_of(kind, coordinates);
}

/// (p − r) × (q − r), a quadratic with vectors for coefficients.
template <class Number>
[[nodiscard]] Bernstein<Vector<Number>, 2> moving_cross(const Moving<Number>& p,
                                                        const Moving<Number>& q,
                                                        const Moving<Number>& r) {
  const Vector<Number> start = cross(p[0] - r[0], q[0] - r[0]);
  const Vector<Number> end = cross(p[1] - r[1], q[1] - r[1]);
  const Vector<Number> velocity = r[1] - r[0];
  const Vector<Number> change = cross((p[1] - p[0]) - velocity, (q[1] - q[0]) - velocity);
  const Vector<Number> sum = start + end - change;
  return {start, {half(sum[0]), half(sum[1]), half(sum[2])}, end};
}

/// n(t), the normal in both forms.
template <class Number>
[[nodiscard]] Bernstein<Vector<Number>, 2> normal_of(const MovingPoints<Number>& points) {
  return moving_cross(points[1], points[2], points[0]);
}

/// Y without the factors of its ends: n_0·w_0, 2n_X·w_0 + n_0·w_1, 2n_X·w_1 + n_1·w_0, n_1·w_1 with
/// w = d − a.
template <class Number>
[[nodiscard]] std::array<Number, 4> coplanarity_products(const MovingPoints<Number>& points,
                                                         const Bernstein<Vector<Number>, 2>& n) {
  const Vector<Number> w0 = points[3][0] - points[0][0], w1 = points[3][1] - points[0][1];
  const Number two(2);
  return {dot(n[0], w0), two * dot(n[1], w0) + dot(n[0], w1), two * dot(n[1], w1) + dot(n[2], w0),
          dot(n[2], w1)};
}

/// Y's coefficients k.
template <class Number>
[[nodiscard]] Bernstein<Number, 3> coplanarity(const MovingPoints<Number>& points,
                                               const Bernstein<Vector<Number>, 2>& n) {
  const auto products = coplanarity_products(points, n);
  const Number three(3);
  return {three * products[0], products[1], products[2], three * products[3]};
}

/// The quartic m·n, of the scale 6.
template <class Number>
[[nodiscard]] Bernstein<Number, 4> product(const Bernstein<Vector<Number>, 2>& m,
                                           const Bernstein<Vector<Number>, 2>& n) {
  const Number three(3), four(4), six(6);
  return {six * dot(m[0], n[0]), three * (dot(m[0], n[1]) + dot(m[1], n[0])),
          dot(m[0], n[2]) + four * dot(m[1], n[1]) + dot(m[2], n[0]),
          three * (dot(m[1], n[2]) + dot(m[2], n[1])), six * dot(m[2], n[2])};
}

/// G_i's coefficients, by i: all three are ≥ 0 at a root of Y iff there is contact.
template <class Number>
[[nodiscard]] Bernstein<Number, 4> inside(ContactKind kind, const MovingPoints<Number>& points,
                                          const Bernstein<Vector<Number>, 2>& n, std::size_t i) {
  const auto& d = points[3];
  Bernstein<Number, 4> result =
      product(moving_cross(points[(i + 1) % 3], points[(i + 2) % 3], d), n);
  if (kind == ContactKind::edge_edge && i == 2) {
    for (Number& x : result) x = -x;
  }
  return result;
}

/// J, by the theorem above.
template <class Number>
[[nodiscard]] Bernstein<Number, 2> reduce(const Bernstein<Number, 3>& k,
                                          const Bernstein<Number, 4>& l) {
  const Number two(2), three(3), four(4), six(6), twelve(12);
  const std::array<Number, 5> e{four * k[0], k[0] + three * k[1], two * k[1] + two * k[2],
                                three * k[2] + k[3], four * k[3]};
  const std::array<Number, 4> s{
      twelve * (l[1] * e[0] - l[0] * e[1]), six * (l[2] * e[0] - l[0] * e[2]),
      four * (l[3] * e[0] - l[0] * e[3]), three * (l[4] * e[0] - l[0] * e[4])};
  return {six * (s[1] * k[0] - s[0] * k[1]), three * (s[2] * k[0] - s[0] * k[2]),
          two * (s[3] * k[0] - s[0] * k[3])};
}

/// T·Y = L·J + K.
template <class Number>
struct Decomposition {
  Number t;
  Bernstein<Number, 1> l;
  Bernstein<Number, 1> k;
};

template <class Number>
[[nodiscard]] Decomposition<Number> decompose(const Bernstein<Number, 3>& k,
                                              const Bernstein<Number, 2>& j) {
  const Number two(2), three(3);
  const Number a = two * (j[1] - j[2]), b = j[0] - j[2], f = two * (j[1] - j[0]);
  const Number c = three * k[2] - two * k[3] - k[0], d = three * k[1] - two * k[0] - k[3];
  const Number t = a * f + b * b, l0 = a * d - b * c, l1 = f * c + b * d;
  return {t, {l0, l1}, {k[0] * t - l0 * j[0], k[3] * t - l1 * j[2]}};
}

/// κ: the derivative of a cubic, over 3.
template <class Number>
[[nodiscard]] Bernstein<Number, 2> derivative(const Bernstein<Number, 3>& k) {
  return {k[1] - k[0], k[2] - k[1], k[3] - k[2]};
}

/// The form at t : s, that is, at t/(t+s), times (t+s)^degree.
template <class Number>
[[nodiscard]] Number value_at(const Bernstein<Number, 2>& q, const Number& t, const Number& s) {
  return q[0] * s * s + Number(2) * q[1] * s * t + q[2] * t * t;
}
template <class Number>
[[nodiscard]] Number value_at(const Bernstein<Number, 3>& k, const Number& t, const Number& s) {
  const Number three(3), ss = s * s, tt = t * t;
  return k[0] * ss * s + three * k[1] * ss * t + three * k[2] * s * tt + k[3] * tt * t;
}

/// The monotonicity of a cubic on [0,1], by its coefficients.
enum class Course { monotone, one_extremum, inflection };

/// One extremum, or none, of a cubic without an inflection. \param opposite of two signs
template <class Number, class Opposite>
[[nodiscard]] Course course_without_inflection(const Bernstein<Number, 3>& k,
                                               const Opposite& opposite) {
  return opposite(k[1] - k[0], k[3] - k[2]) ? Course::one_extremum : Course::monotone;
}

/// True if one end's coefficient differs in sign from all the others. Then there is exactly one
/// root.
template <class Number, class Opposite>
[[nodiscard]] bool has_lone_end(const Bernstein<Number, 3>& k, const Opposite& opposite) {
  return (opposite(k[0], k[1]) && opposite(k[0], k[2]) && opposite(k[0], k[3])) ||
         (opposite(k[3], k[0]) && opposite(k[3], k[1]) && opposite(k[3], k[2]));
}

/// The course of a cubic; a lone end counts as monotone, which for roots it is.
/// \param certainly and possibly: true if the signs of two numbers are opposite
template <class Number, class Certainly, class Possibly>
[[nodiscard]] Course course_of(const Bernstein<Number, 3>& k, const Certainly& certainly,
                               const Possibly& possibly) {
  if (has_lone_end(k, certainly)) return Course::monotone;
  const Number two(2);
  if (possibly(k[2] - two * k[1] + k[0], k[3] - two * k[2] + k[1])) return Course::inflection;
  return course_without_inflection(k, possibly);
}

}  // namespace touchstone::verify::published

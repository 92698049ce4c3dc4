#pragma once

/// \file
/// Two primitives at a time in rational numbers, for tests: their nearest points in L2, and their
/// distance, by enumeration. It shares nothing with fast/distance/.
///
/// The square of the length is least at a foot of the origin on the plane or on a side of the
/// polygon, or at a corner. A point of the polygon is a point of a triangle of three corners (with
/// repetitions if it has fewer). On a triangle's plane, with parameters a and b, the greatest
/// component is least where two of these numbers are 0: a, b, 1 − a − b, the components of the
/// point, and their sums and differences (a linear program's vertex). All such points are tried.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "tests/support/queries.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/number.hpp"
#include "touchstone/query.hpp"

namespace touchstone::tests {

namespace exact_pair {

using exact::Rational;
using Vector = std::array<Rational, 3>;

[[nodiscard]] inline Vector sum(const Vector& a, const Rational& s, const Vector& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
[[nodiscard]] inline Rational dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline Vector negative(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
[[nodiscard]] inline bool is_zero(const Vector& a) { return dot(a, a) == 0; }
[[nodiscard]] inline Vector rational(const Eigen::Vector3d& x) {
  return {Rational(x[0]), Rational(x[1]), Rational(x[2])};
}

/// A query in rationals.
struct ExactPair {
  const PosedQuery& posed;

  [[nodiscard]] Vector point(std::size_t i, const Rational& t) const {
    const Vector start = rational(point_of(posed.query, 0, i)),
                 end = rational(point_of(posed.query, 1, i));
    return sum(start, t, sum(end, -1, start));
  }
  /// r, p or q at a time.
  [[nodiscard]] Vector vector(std::size_t i, const Rational& t) const {
    const auto points = affine_vectors(posed.kind)[i];
    return sum(point(points[0], t), -1, point(points[1], t));
  }
  [[nodiscard]] Vector difference(const Rational& t, const Rational& u, const Rational& v) const {
    return sum(sum(vector(0, t), -u, vector(1, t)), -v, vector(2, t));
  }
  [[nodiscard]] Vector product(const Rational& t) const {
    return cross(vector(1, t), vector(2, t));
  }
  [[nodiscard]] Vector rate(const Rational& u, const Rational& v) const {
    return sum(difference(1, u, v), -1, difference(0, u, v));
  }
};

/// The parameters of the nearest points, of all feet and corners in the domain.
[[nodiscard]] inline std::pair<Rational, Rational> nearest_exactly(const ExactPair& pair,
                                                                   const Rational& t) {
  const Vector r = pair.vector(0, t), p = pair.vector(1, t), q = pair.vector(2, t);
  const bool is_face = pair.posed.kind == ContactKind::vertex_face;
  std::optional<Rational> least;
  std::pair<Rational, Rational> best;
  const auto consider = [&](const Rational& u, const Rational& v) {
    if (u < 0 || v < 0 || (is_face ? u + v > 1 : u > 1 || v > 1)) return;
    const Vector f = pair.difference(t, u, v);
    const Rational square = dot(f, f);
    if (least && square >= *least) return;
    least = square;
    best = {u, v};
  };
  /// From (u,v) by (du,dv).
  const auto side = [&](int u, int v, int du, int dv) {
    const Vector f = pair.difference(t, u, v), e = sum(pair.difference(t, u + du, v + dv), -1, f);
    const Rational square = dot(e, e);
    Rational s = square == 0 ? Rational(0) : Rational(-dot(f, e) / square);
    s = s < 0 ? Rational(0) : s > 1 ? Rational(1) : s;
    consider(u + s * du, v + s * dv);
  };
  side(0, 0, 1, 0), side(0, 0, 0, 1);
  is_face ? side(1, 0, -1, 1) : (side(1, 0, 0, 1), side(0, 1, 1, 0));
  const Vector n = cross(p, q);
  if (const Rational square = dot(n, n); square != 0) {
    consider(dot(n, cross(r, q)) / square, dot(n, cross(p, r)) / square);
  }
  return best;
}

/// c + a·x + b·y = 0.
struct Line {
  Rational a, b, c;
};

/// The least of the greatest components of the points of a triangle.
[[nodiscard]] inline Rational least_component(const Vector& w, const Vector& x, const Vector& y) {
  const Vector p = sum(x, -1, w), q = sum(y, -1, w);
  std::vector<Line> lines{{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    lines.push_back({p[i], q[i], w[i]});
    for (std::size_t k = 0; k < i; ++k) {
      lines.push_back({p[i] - p[k], q[i] - q[k], w[i] - w[k]});
      lines.push_back({p[i] + p[k], q[i] + q[k], w[i] + w[k]});
    }
  }
  std::optional<Rational> least;
  for (const Line& one : lines) {
    for (const Line& other : lines) {
      const Rational determinant = one.a * other.b - one.b * other.a;
      if (determinant == 0) continue;
      const Rational a = (one.b * other.c - other.b * one.c) / determinant;
      const Rational b = (other.a * one.c - one.a * other.c) / determinant;
      if (a < 0 || b < 0 || a + b > 1) continue;
      Rational greatest = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        greatest = std::max(greatest, Rational(abs(Rational(w[k] + a * p[k] + b * q[k]))));
      }
      least = least ? std::min(*least, greatest) : greatest;
    }
  }
  return *least;
}

/// The distance in L∞; in L2, its square.
[[nodiscard]] inline Rational distance_at_time(const PosedQuery& posed, double t, Norm norm) {
  const ExactPair pair{posed};
  const Rational time(t);
  if (norm == Norm::l2) {
    const auto [u, v] = nearest_exactly(pair, time);
    const Vector f = pair.difference(time, u, v);
    return dot(f, f);
  }
  std::vector<Vector> w{pair.difference(time, 0, 0), pair.difference(time, 1, 0),
                        pair.difference(time, 0, 1)};
  if (posed.kind == ContactKind::edge_edge) w.push_back(pair.difference(time, 1, 1));
  Rational least = least_component(w[0], w[1], w[2]);
  if (w.size() > 3) least = std::min(least, least_component(w[1], w[2], w[3]));
  return least;
}

}  // namespace exact_pair

/// The sign of the distance minus a number that is not negative.
[[nodiscard]] inline int compare_distance(const exact::Rational& measure, Norm norm,
                                          const exact::Rational& number) {
  return cmp(measure, norm == Norm::l2 ? exact::Rational(number * number) : number);
}

}  // namespace touchstone::tests

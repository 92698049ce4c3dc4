#pragma once

/// \file
/// The distance of two primitives at a time in rational numbers, for tests, by enumeration.
///
/// A point of the polygon is a point of a triangle of three corners (with repetitions if it has
/// fewer). On a triangle's plane, with parameters a and b,
/// - the square of the length is least where its gradient is 0 inside, or on one of the lines that
///   bound the triangle, or at a corner;
/// - the greatest component is least where two of these numbers are 0: a, b, 1 − a − b, the
///   components of the point, and their sums and differences (a linear program's vertex).
/// All such points in the triangle are tried. It shares nothing with fast/distance/.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "exact/algebra/number.hpp"
#include "exact/query.hpp"

namespace touchstone::tests {

class DistanceAtTime {
 public:
  using Rational = exact::Rational;
  using Vector = std::array<Rational, 3>;

  DistanceAtTime(Kind kind, const Query& query, double t) {
    const Rational time(t);
    for (const Corner& corner : corners(kind)) {
      Vector& w = w_.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](std::size_t end) {
          return Rational(Rational(query.at(end, corner.plus, axis)) -
                          Rational(query.at(end, corner.minus, axis)));
        };
        w[axis] = (1 - time) * at(0) + time * at(1);
      }
    }
  }

  /// The distance in L∞; in L2, its square.
  [[nodiscard]] Rational measure(Norm norm) {
    least_.reset();
    for (std::size_t i = 0; i < w_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          norm == Norm::l2 ? try_lengths(w_[i], w_[j], w_[k]) : try_components(w_[i], w_[j], w_[k]);
        }
      }
    }
    return *least_;
  }

 private:
  static Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Rational dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  void consider(const Rational& measure) {
    if (!least_ || measure < *least_) least_ = measure;
  }

  // ---- L2 ----

  void try_segment(const Vector& w, const Vector& e) {
    const Rational square = dot(e, e), along = -dot(w, e);
    consider(dot(w, w));
    if (along <= 0 || along >= square) return;
    consider(dot(w, w) - along * along / square);
  }

  void try_lengths(const Vector& w, const Vector& x, const Vector& y) {
    const Vector p = minus(x, w), q = minus(y, w);
    try_segment(w, p);
    try_segment(x, minus(y, x));
    try_segment(y, minus(w, y));
    const Rational pp = dot(p, p), pq = dot(p, q), qq = dot(q, q), determinant = pp * qq - pq * pq;
    if (determinant == 0) return;
    const Rational wp = dot(w, p), wq = dot(w, q);
    const Rational a = (pq * wq - qq * wp) / determinant, b = (pq * wp - pp * wq) / determinant;
    if (a < 0 || b < 0 || a + b > 1) return;
    Vector point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = w[k] + a * p[k] + b * q[k];
    consider(dot(point, point));
  }

  // ---- L∞ ----

  /// c + a·x + b·y = 0.
  struct Line {
    Rational a, b, c;
  };

  void try_components(const Vector& w, const Vector& x, const Vector& y) {
    const Vector p = minus(x, w), q = minus(y, w);
    std::vector<Line> lines{{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};
    for (std::size_t i = 0; i < 3; ++i) {
      lines.push_back({p[i], q[i], w[i]});
      for (std::size_t k = 0; k < i; ++k) {
        lines.push_back({p[i] - p[k], q[i] - q[k], w[i] - w[k]});
        lines.push_back({p[i] + p[k], q[i] + q[k], w[i] + w[k]});
      }
    }
    for (const Line& one : lines) {
      for (const Line& other : lines) {
        const Rational determinant = one.a * other.b - one.b * other.a;
        if (determinant == 0) continue;
        const Rational a = (one.b * other.c - other.b * one.c) / determinant;
        const Rational b = (other.a * one.c - one.a * other.c) / determinant;
        if (a < 0 || b < 0 || a + b > 1) continue;
        Rational greatest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const Rational component = abs(Rational(w[k] + a * p[k] + b * q[k]));
          if (component > greatest) greatest = component;
        }
        consider(greatest);
      }
    }
  }

  std::vector<Vector> w_;
  std::optional<Rational> least_;
};

/// The sign of the distance minus a number that is not negative.
[[nodiscard]] inline int compare_distance(const exact::Rational& measure, Norm norm,
                                          const exact::Rational& number) {
  return cmp(measure, norm == Norm::l2 ? exact::Rational(number * number) : number);
}

}  // namespace touchstone::tests

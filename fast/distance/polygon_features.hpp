#pragma once

/// \file
/// The distance of two primitives at one time, in sums and products of numbers of any type.
///
/// P is the convex hull of the differences of the primitives' points, the corners w_i
/// (touchstone/query.hpp). The distance is that of P from the origin. Corners that coincide at all
/// times are taken once, so P is a segment for a vertex and an edge, and a point for two vertices.
/// Let ij be a side of P, e = w_j − w_i, m = w_i × w_j, and N = (w_1 − w_0) × (w_last − w_0).
///
/// **Theorem 1** (L2, upper bounds). The square of the distance is the least of
///   - vertex: |w_i|²;
///   - side, if w_i·e < 0 < w_j·e: |m|² / |e|²;
///   - face, if N ≠ 0 and N·(w_i × w_j) ≥ 0 for every side: (N·w_0)² / |N|².
/// Proof. The conditions say that the foot of the perpendicular from the origin is on the side or
/// in the face, so each is the square of the length of a point of P. The nearest point is in the
/// relative interior of a vertex, a side or the face, and the foot on that. ∎
///
/// **Theorem 2** (L2, lower bounds). The distance is more than s iff for one direction a among w_i,
/// |e|² w_i − (w_i·e) e and ±N, all a·w_k are positive and (a·w_k)² > s² |a|². With V = a·w_i and |a|²
///   - vertex: V = |w_i|², |a|² = V;
///   - side: V = |m|² = a·w_j, |a|² = |e|² V, and a·w_k = m·(w_k × e) for the others;
///   - face: V = N·w_0 for all corners, |a|² = |N|².
/// Proof. docs/theory.md, section 3.2, and (x × e)·(y × e) = (x·y)(e·e) − (x·e)(y·e). ∎
///
/// **Theorem 3** (L∞). The distance is the greatest of  max(min a·w_k, −max a·w_k) / |a|₁  over the
/// axes a ≠ 0 among e_c, N and e_c × e, where e_c is a coordinate axis; and 0, if that is negative.
/// Proof. An axis keeps P away from every cube of half side less than that. Conversely, if P misses
/// the cube of half side s, one of the axes separates it (docs/theory.md, section 3.3): its
/// quotient is more than s. ∎

#include <algorithm>
#include <array>
#include <cstddef>

#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::polygon {

template <class Number>
using Vector = filters::Vector3<Number>;

/// The corners that differ, in cyclic order.
struct CornerList {
  std::array<Corner, 4> items{};
  std::size_t count = 0;
};

[[nodiscard]] inline CornerList distinct_corners(ContactKind kind, const Query& query) {
  const auto coordinates = [&](std::size_t point) {
    std::array<double, 6> result{};
    for (std::size_t i = 0; i < 6; ++i) result[i] = query.at(i / 3, point, i % 3);
    return result;
  };
  const auto same = [&](std::size_t a, std::size_t b) {
    return a == b || coordinates(a) == coordinates(b);
  };
  CornerList result;
  for (const Corner& corner : corners(kind)) {
    const auto taken = std::span(result.items).first(result.count);
    const bool is_new = std::ranges::none_of(taken, [&](const Corner& other) {
      return same(other.plus, corner.plus) && same(other.minus, corner.minus);
    });
    if (is_new) result.items[result.count++] = corner;
  }
  return result;
}

/// P.
template <class Number>
struct Polygon {
  std::array<Vector<Number>, 4> corner{};
  std::size_t count = 0;

  [[nodiscard]] std::size_t sides() const { return count < 3 ? count - 1 : count; }
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 < count ? i + 1 : 0; }
  [[nodiscard]] bool has_face() const { return count > 2; }
};

/// at(corner, axis): a coordinate of a corner.
template <class Number, class At>
[[nodiscard]] Polygon<Number> polygon_of(const CornerList& corners, const At& at) {
  Polygon<Number> result;
  result.count = corners.count;
  for (std::size_t i = 0; i < corners.count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.corner[i][axis] = at(corners.items[i], axis);
    }
  }
  return result;
}

template <class Number>
[[nodiscard]] Vector<Number> difference(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// ---- L2 -----------------------------------------------------------------------------------------

template <class Number>
struct Side {
  Vector<Number> e, m;
  Number square;    ///< |e|²
  Number area;      ///< |m|²
  Number from, to;  ///< w_i·e and w_j·e
};

/// The side that begins at corner i.
template <class Number>
[[nodiscard]] Side<Number> side(const Polygon<Number>& p, std::size_t i) {
  const Vector<Number>&a = p.corner[i], &b = p.corner[p.next(i)];
  Side<Number> result;
  result.e = difference(b, a);
  result.m = filters::cross(a, result.e);
  result.square = filters::dot(result.e, result.e);
  result.area = filters::dot(result.m, result.m);
  result.from = filters::dot(a, result.e);
  result.to = filters::dot(b, result.e);
  return result;
}

template <class Number>
struct Face {
  Vector<Number> normal;
  Number square;                  ///< |N|²
  Number height;                  ///< N·w_0
  std::array<Number, 4> turns{};  ///< N·(w_i × w_j) of each side
};

/// \pre p.has_face()
template <class Number>
[[nodiscard]] Face<Number> face(const Polygon<Number>& p) {
  const auto& w = p.corner;
  Face<Number> result;
  result.normal = filters::cross(difference(w[1], w[0]), difference(w[p.count - 1], w[0]));
  result.square = filters::dot(result.normal, result.normal);
  result.height = filters::dot(result.normal, w[0]);
  for (std::size_t i = 0; i < p.count; ++i) {
    result.turns[i] = filters::dot(result.normal, filters::cross(w[i], w[p.next(i)]));
  }
  return result;
}

/// The |N|² up to which a normal in doubles has no correct digit. \pre p.has_face()
template <class Number>
[[nodiscard]] Number square_of_thin_normal(const Polygon<Number>& p) {
  const Vector<Number> first = difference(p.corner[1], p.corner[0]);
  const Vector<Number> last = difference(p.corner[p.count - 1], p.corner[0]);
  return Number(0x1p-60) * (filters::dot(first, first) * filters::dot(last, last));
}

// ---- L∞ -----------------------------------------------------------------------------------------

/// An axis a: the a·w_k that differ, and |a|₁.
template <class Number>
struct Axis {
  std::array<Number, 4> values{};
  std::size_t count = 0;
  Number length{};
};

template <class Number>
struct AxisList {
  static constexpr std::size_t most = 3 + 3 * 3 + 1;
  std::array<Axis<Number>, most> items{};
  std::size_t count = 0;
};

/// All axes of theorem 3. Both ends of a side have the same product with e_c × e, and so have those
/// of the opposite side of a parallelogram.
template <class Number>
[[nodiscard]] AxisList<Number> axes(const Polygon<Number>& p) {
  const auto& w = p.corner;
  AxisList<Number> result;
  for (std::size_t c = 0; c < 3; ++c) {
    Axis<Number>& axis = result.items[result.count++];
    axis.count = p.count;
    for (std::size_t i = 0; i < p.count; ++i) axis.values[i] = w[i][c];
    axis.length = Number(1);
  }
  const std::size_t directions = p.count == 4 ? 2 : p.sides();
  for (std::size_t i = 0; i < directions; ++i) {
    const std::size_t j = p.next(i);
    const Vector<Number> e = difference(w[j], w[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t y = (c + 1) % 3, z = (c + 2) % 3;
      Axis<Number>& axis = result.items[result.count++];
      axis.count = p.has_face() ? 2 : 1;
      axis.values[0] = e[y] * w[i][z] - e[z] * w[i][y];
      const Vector<Number>& other = w[p.next(j)];
      if (p.has_face()) axis.values[1] = e[y] * other[z] - e[z] * other[y];
      axis.length = abs(e[y]) + abs(e[z]);
    }
  }
  if (p.has_face()) {
    const Vector<Number> n =
        filters::cross(difference(w[1], w[0]), difference(w[p.count - 1], w[0]));
    Axis<Number>& axis = result.items[result.count++];
    axis.values[0] = filters::dot(n, w[0]);
    axis.count = 1;
    axis.length = abs(n[0]) + abs(n[1]) + abs(n[2]);
  }
  return result;
}

}  // namespace touchstone::fast::polygon

#pragma once

/// \file
/// The corners of a query on curves by their control points, in doubles with a bound of their
/// errors.
///
/// Let the points of a primitive have weights in common, as on a rigid body, or none. With
/// numerators a_i ω_i and b_j φ_j of degree k, the corner a − b times both denominators is the
/// curve of degree 2k with the control points
///
///     Σ_{i+j=m} α_ij ω_i φ_j (a_i − b_j),   α_ij = C(k,i) C(k,j) / C(2k,m),   Σ α_ij = 1.
///
/// If the weights of both are equal, one denominator is enough: degree k, ω_m (a_m − b_m); without
/// weights a_m − b_m. The distance is multiplied by the same, and its control values follow.
///
/// **Errors.** Let M be the greatest magnitude of a term without its α, u = 2^-53. A control value
/// is computed by at most k + 6 roundings of terms whose magnitudes add up to at most M: its error
/// is at most (k + 7) u M while nothing underflows; 2^-1060 covers underflow (no weight is
/// subnormal). **Halving** a curve takes means (a + b)/2, which never exceed the greater of both. A
/// mean has the error of a sum, at most u M, and an underflow; it keeps the errors of a and b below
/// the greater of both, because it is a convex combination. So each half of a curve of degree K has
/// the error of the whole plus at most K (u M + 2^-1074).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast::curved {

/// The least degree that is enough for all queries with a control polygon.
inline constexpr std::size_t greatest_corner_degree = 8;
inline constexpr double unit_roundoff = 0x1p-53;
inline constexpr double underflow = 0x1p-1060;
/// Control values above this are left to the exact stage: no cube of them overflows.
inline constexpr double greatest_magnitude = 0x1p100;

/// The values of a moving corner's coordinate: of corner i on an axis at place 4 axis + i. A
/// triangle's last corner counts twice.
using CornerRow = std::array<double, 12>;

struct ControlPolygon {
  std::size_t degree;
  std::array<CornerRow, greatest_corner_degree + 1> w;
  /// The control values of the distance times the denominator.
  std::array<double, greatest_corner_degree + 1> reach;
  double magnitude;  ///< M: of all values of w and reach
  double error;      ///< of all values of w and reach

  [[nodiscard]] double at(std::size_t k, std::size_t axis, std::size_t corner) const {
    return w[k][4 * axis + corner];
  }

  /// Copies what the degree makes use of.
  void assign(const ControlPolygon& other) {
    degree = other.degree;
    std::copy_n(other.w.begin(), degree + 1, w.begin());
    std::copy_n(other.reach.begin(), degree + 1, reach.begin());
    magnitude = other.magnitude;
    error = other.error;
  }
};

enum class Loaded : std::uint8_t { yes, unusual };

/// The numbers of a query, and what follows from their layout.
class ControlPoints {
 public:
  ControlPoints(Kind kind, const CurvedQueries& queries, std::size_t i)
      : kind_(kind), queries_(queries), row_(queries.row(i)) {}

  [[nodiscard]] double x(std::size_t k, std::size_t point, std::size_t axis) const {
    return row_[(k * moving_points + point) * queries_.numbers_of_point() + axis];
  }
  [[nodiscard]] double weight(std::size_t k, std::size_t point) const {
    return queries_.is_rational ? x(k, point, 3) : 1.0;
  }
  [[nodiscard]] std::size_t degree() const { return queries_.degree; }
  [[nodiscard]] std::span<const double> row() const { return row_; }
  [[nodiscard]] bool is_rational() const { return queries_.is_rational; }
  /// The first point of the second primitive.
  [[nodiscard]] std::size_t second() const { return kind_ == Kind::vertex_face ? 1 : 2; }

  /// True if both points have the same weights.
  [[nodiscard]] bool have_equal_weights(std::size_t a, std::size_t b) const {
    if (!queries_.is_rational) return true;
    for (std::size_t k = 0; k <= degree(); ++k) {
      if (weight(k, a) != weight(k, b)) return false;
    }
    return true;
  }
  /// True if the points of each primitive have weights in common, which are not so small or large
  /// that products of them underflow or overflow.
  [[nodiscard]] bool are_rigid() const {
    constexpr double least = 0x1p-30, most = 0x1p30;
    if (!queries_.is_rational) return true;
    for (const std::size_t point : {std::size_t{0}, second()}) {
      for (std::size_t k = 0; k <= degree(); ++k) {
        if (!(weight(k, point) >= least && weight(k, point) <= most)) return false;
      }
    }
    for (std::size_t point = 1; point < moving_points; ++point) {
      if (point != second() && !have_equal_weights(point, point < second() ? 0 : second())) {
        return false;
      }
    }
    return true;
  }

 private:
  Kind kind_;
  const CurvedQueries& queries_;
  std::span<const double> row_;
};

/// The points whose difference a corner is; a triangle's last corner twice.
inline const Corner& corner_of(Kind kind, std::size_t i) {
  return kind == Kind::vertex_face ? vertex_face_corners[i < 3 ? i : 2] : edge_edge_corners[i];
}

/// True if on an axis all control points of one primitive are farther than the distance beyond all
/// of the other: then no time is a contact, since each point is in the hull of its control points.
/// Exact but for the difference, which is rounded and does not exceed the distance if it is not
/// beyond. False if a number is not finite or a weight is not positive.
template <Kind kind, bool is_rational>
inline bool is_apart_on_axis(std::span<const double> row, double distance) {
  constexpr std::size_t stride = is_rational ? 4 : 3, size = moving_points * stride;
  std::array<double, size> least, most, check;
  for (std::size_t i = 0; i < size; ++i) least[i] = most[i] = row[i];
  for (std::size_t i = 0; i < size; ++i) check[i] = row[i] - row[i];
  for (std::size_t first = size; first < row.size(); first += size) {
    for (std::size_t i = 0; i < size; ++i) {
      const double x = row[first + i];
      least[i] = x < least[i] ? x : least[i];
      most[i] = x > most[i] ? x : most[i];
      check[i] += x - x;
    }
  }
  double sum = 0.0;
  for (const double x : check) sum += x;
  if (!(sum == 0.0)) return false;
  if constexpr (is_rational) {
    for (std::size_t point = 0; point < moving_points; ++point) {
      if (!(least[stride * point + 3] > 0.0)) return false;
    }
  }
  constexpr std::size_t second = kind == Kind::vertex_face ? 1 : 2;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least_a = least[axis], most_a = most[axis];
    double least_b = least[stride * second + axis], most_b = most[stride * second + axis];
    for (std::size_t point = 1; point < moving_points; ++point) {
      const std::size_t place = stride * point + axis;
      if (point < second) {
        least_a = std::min(least_a, least[place]);
        most_a = std::max(most_a, most[place]);
      } else {
        least_b = std::min(least_b, least[place]);
        most_b = std::max(most_b, most[place]);
      }
    }
    if (least_a - most_b > distance || least_b - most_a > distance) return true;
  }
  return false;
}

/// Sets magnitude and error after so many roundings, from the greatest term.
inline Loaded finish(ControlPolygon& polygon, double greatest_term, double roundings) {
  polygon.magnitude = greatest_term;
  polygon.error = roundings * unit_roundoff * greatest_term + underflow;
  // Written so that NaN fails too.
  return greatest_term <= greatest_magnitude ? Loaded::yes : Loaded::unusual;
}

/// One denominator, or none.
template <Kind kind>
inline Loaded load_alike(const ControlPoints& from, double distance, ControlPolygon& polygon) {
  polygon.degree = from.degree();
  double greatest = 0.0, sum = 0.0;
  for (std::size_t k = 0; k <= polygon.degree; ++k) {
    const double weight = from.weight(k, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < 4; ++i) {
        const Corner& corner = corner_of(kind, i);
        const double w = (from.x(k, corner.plus, axis) - from.x(k, corner.minus, axis)) * weight;
        polygon.w[k][4 * axis + i] = w;
        greatest = std::max(greatest, std::abs(w));
        sum += w - w;  // NaN if w is not finite
      }
    }
    polygon.reach[k] = distance * weight;
    greatest = std::max(greatest, polygon.reach[k]);
  }
  return finish(polygon, greatest + sum, 3.0);
}

/// The product of two denominators.
template <Kind kind>
inline Loaded load_product(const ControlPoints& from, double distance, ControlPolygon& polygon) {
  const std::size_t k = from.degree();
  polygon.degree = 2 * k;
  for (std::size_t m = 0; m <= 2 * k; ++m) {
    polygon.w[m].fill(0.0);
    polygon.reach[m] = 0.0;
  }
  const auto binomial = [](std::size_t n, std::size_t i) {
    double result = 1.0;
    for (std::size_t j = 0; j < i; ++j) {
      result = result * static_cast<double>(n - j) / static_cast<double>(j + 1);
    }
    return result;
  };
  double greatest = 0.0, sum = 0.0;
  for (std::size_t i = 0; i <= k; ++i) {
    for (std::size_t j = 0; j <= k; ++j) {
      const double alpha = binomial(k, i) * binomial(k, j) / binomial(2 * k, i + j);
      const double weight = from.weight(i, 0) * from.weight(j, from.second());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t c = 0; c < 4; ++c) {
          const Corner& corner = corner_of(kind, c);
          const double term =
              (from.x(i, corner.plus, axis) - from.x(j, corner.minus, axis)) * weight;
          polygon.w[i + j][4 * axis + c] += term * alpha;
          greatest = std::max(greatest, std::abs(term));
          sum += term - term;
        }
      }
      polygon.reach[i + j] += distance * weight * alpha;
      greatest = std::max(greatest, distance * weight);
    }
  }
  return finish(polygon, greatest + sum, static_cast<double>(k) + 7.0);
}

/// Fills the control polygon of a query. `unusual`: with numbers that are not finite or too large,
/// or with weights that are not in common.
template <Kind kind>
inline Loaded load(const ControlPoints& from, double distance, ControlPolygon& polygon) {
  if (!from.are_rigid()) return Loaded::unusual;
  if (from.have_equal_weights(0, from.second())) return load_alike<kind>(from, distance, polygon);
  if (2 * from.degree() > greatest_corner_degree) return Loaded::unusual;
  return load_product<kind>(from, distance, polygon);
}

/// Both halves of the time, by de Casteljau's algorithm.
inline void halve(const ControlPolygon& whole, ControlPolygon& first, ControlPolygon& second) {
  const std::size_t degree = whole.degree;
  second.assign(whole);
  second.error += static_cast<double>(degree) * (unit_roundoff * whole.magnitude + underflow);
  first.degree = degree;
  first.magnitude = second.magnitude;
  first.error = second.error;
  for (std::size_t k = 0; k <= degree; ++k) {
    first.w[k] = second.w[0];
    first.reach[k] = second.reach[0];
    for (std::size_t j = 0; j + k < degree; ++j) {
      for (std::size_t i = 0; i < second.w[j].size(); ++i) {
        second.w[j][i] = (second.w[j][i] + second.w[j + 1][i]) * 0.5;
      }
      second.reach[j] = (second.reach[j] + second.reach[j + 1]) * 0.5;
    }
  }
}

/// The corners at a time y of the piece, an approximation.
inline CornerRow corners_at(const ControlPolygon& polygon, double y) {
  auto w = polygon.w;
  for (std::size_t level = polygon.degree; level > 0; --level) {
    for (std::size_t j = 0; j < level; ++j) {
      for (std::size_t i = 0; i < w[j].size(); ++i) w[j][i] += (w[j + 1][i] - w[j][i]) * y;
    }
  }
  return w[0];
}

}  // namespace touchstone::fast::curved

#pragma once

/// \file
/// Queries whose points move on curves.
///
/// A point's position is a Bézier curve of degree k, x(t) = Σ_j B_j(t) b_j with the Bernstein
/// polynomials B_j(t) = binomial(k, j) (1−t)^(k−j) t^j, or a rational one with positive weights,
/// x(t) = Σ_j B_j(t) w_j b_j / Σ_j B_j(t) w_j. All numbers are doubles that stand for themselves.
/// Everything else is as for straight lines, which are curves of degree 1 (touchstone/query.hpp).

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "touchstone/query.hpp"

namespace touchstone {

/// The greatest degree of a trajectory.
inline constexpr std::size_t greatest_degree = 8;

/// The motion of a point from t=0 to t=1.
struct Trajectory {
  /// The control points b_j: at least 1, and at most greatest_degree + 1.
  std::vector<std::array<double, 3>> control;
  /// The weights w_j > 0, as many; empty for a polynomial curve.
  std::vector<double> weights = {};

  [[nodiscard]] std::size_t degree() const { return control.size() - 1; }
  friend bool operator==(const Trajectory&, const Trajectory&) = default;
};

/// The four points in the order of Query, each on a curve of its own degree.
using CurvedQuery = std::array<Trajectory, moving_points>;

/// Queries on curves of one degree in an array, by reference.
struct CurvedQueries {
  std::size_t degree = 1;
  /// Weights follow the coordinates of each control point.
  bool is_rational = false;
  /// For each query the control points from t=0 to t=1, each of the four points in the order of
  /// Query: an array of shape (size, degree + 1, 4, 3), or (size, degree + 1, 4, 4) with weights.
  std::span<const double> numbers = {};

  [[nodiscard]] std::size_t numbers_of_point() const { return is_rational ? 4 : 3; }
  [[nodiscard]] std::size_t numbers_of_query() const {
    return (degree + 1) * moving_points * numbers_of_point();
  }
  [[nodiscard]] std::size_t size() const { return numbers.size() / numbers_of_query(); }
  /// The numbers of query i.
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    return numbers.subspan(i * numbers_of_query(), numbers_of_query());
  }
  /// Query i as it is decided exactly.
  [[nodiscard]] CurvedQuery query(std::size_t i) const {
    CurvedQuery result;
    const std::span<const double> all = row(i);
    for (std::size_t place = 0; place < all.size(); place += numbers_of_point()) {
      Trajectory& curve = result[place / numbers_of_point() % moving_points];
      curve.control.push_back({all[place], all[place + 1], all[place + 2]});
      if (is_rational) curve.weights.push_back(all[place + 3]);
    }
    return result;
  }
};

/// The same query on curves of degree 1.
[[nodiscard]] inline CurvedQuery to_curved(const Query& query) {
  CurvedQuery result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t end = 0; end < 2; ++end) {
      result[point].control.push_back(
          {query.at(end, point, 0), query.at(end, point, 1), query.at(end, point, 2)});
    }
  }
  return result;
}

}  // namespace touchstone

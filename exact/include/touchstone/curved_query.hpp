#pragma once

/// \file
/// Queries whose points move on curves of different degrees.
///
/// The trajectories are those of touchstone::QueryShape; each double is taken as the number it is.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "touchstone/query.hpp"

namespace touchstone {

/// The motion of a point from t=0 to t=1.
struct Trajectory {
  /// The control points b_j: at least 1, and at most greatest_degree + 1.
  std::vector<std::array<double, 3>> control;
  /// The weights w_j > 0, one per control point; empty for a polynomial curve.
  std::vector<double> weights = {};

  [[nodiscard]] std::size_t degree() const { return control.size() - 1; }
  friend bool operator==(const Trajectory&, const Trajectory&) = default;
};

/// The four points in the order of Query, each on a curve of its own degree.
using CurvedQuery = std::array<Trajectory, moving_points>;

/// The query that decides one of this kind.
[[nodiscard]] inline CurvedQuery decided_query(ContactKind kind, CurvedQuery query) {
  for (std::size_t point = 0; point < query.size(); ++point) {
    query[point] = query[decided_point(kind, point)];
  }
  return query;
}

/// Query or cell i with a trajectory for each point.
template <class Kind>
[[nodiscard]] CurvedQuery to_curved(const Batch<Kind>& queries, std::size_t i) {
  CurvedQuery result;
  const std::span<const double> all = queries.row(i);
  const std::size_t size = queries.numbers_of_point();
  for (std::size_t place = 0; place < all.size(); place += size) {
    Trajectory& curve = result[place / size % moving_points];
    curve.control.push_back({all[place], all[place + 1], all[place + 2]});
    if (queries.is_rational) curve.weights.push_back(all[place + 3]);
  }
  return result;
}

/// The same query on curves of degree 1.
[[nodiscard]] inline CurvedQuery to_curved(const Query& query) {
  return to_curved(Queries(ContactKind::vertex_face, {&query, 1}), 0);
}

}  // namespace touchstone

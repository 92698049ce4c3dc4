#pragma once

/// \file
/// IRF and UIRF: their moving points in intervals [moore1966], and depth-first bisection of a box
/// of parameters. ([snyder1992], algorithm SOLVE.)
///
/// A box is dropped only if the problem proves that it holds no solution, and split boxes are
/// covered by their halves, so if all are dropped there is none. A box that is small on all axes
/// and that the problem accepts ends the search. Dimensions are split in turn; the lower half is
/// searched first. In one dimension boxes therefore come in ascending order, and the accepted one
/// begins no later than any solution; in several it is an arbitrary one.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "touchstone/mesh.hpp"
#include "touchstone/plugin.h"
#include "touchstone/query.hpp"
#include "verify/published/bernstein.hpp"
#include "verify/published/upward_interval.hpp"

namespace touchstone::verify::published {

template <std::size_t Dimensions>
using ParameterBox = std::array<UpwardInterval, Dimensions>;

/// Outcome of a search.
template <std::size_t Dimensions>
struct IntervalSearchResult {
  /// yes: a box was accepted. no: all were dropped. undecided: the checks ran out.
  TouchstoneVerdict verdict;
  ParameterBox<Dimensions> box;  ///< with yes: the accepted one
};

/// The dimension to split a box along: in cyclic order the first one after the last split whose
/// width is above its tolerance; none if all are small. A width that cannot be halved in doubles is
/// small.
template <std::size_t Dimensions>
[[nodiscard]] std::optional<std::size_t> dimension_to_split(
    const ParameterBox<Dimensions>& box, const std::array<double, Dimensions>& tolerances,
    std::size_t last_split) {
  for (std::size_t step = 1; step <= Dimensions; ++step) {
    const std::size_t dimension = (last_split + step) % Dimensions;
    const UpwardInterval& side = box[dimension];
    const double middle = middle_of(side), width = side.upper + side.minus_lower;
    const bool can_halve = -side.minus_lower < middle && middle < side.upper;
    if (can_halve && width > tolerances[dimension]) return dimension;
  }
  return std::nullopt;
}

/// A box in the queue, and the dimension of its last split.
template <std::size_t Dimensions>
struct WaitingBox {
  ParameterBox<Dimensions> box;
  std::size_t last_split;
};

/// Searches a box, rounding upward. Problem has, as const functions of a ParameterBox:
///   - may_vanish(box): false only if it holds no solution;
///   - reaches_domain(box): false only if it holds no point of the domain; called for each half of
///     a split in any dimension but the first;
///   - accepts(box): true if a small box that may hold a solution counts as one.
/// \param tolerances Widths that count as small, in the order of the dimensions; infinite: any
/// width.
/// \param max_checks The maximum number of boxes examined; not positive: no limit.
template <std::size_t Dimensions, class Problem>
[[nodiscard]] IntervalSearchResult<Dimensions> search_box(
    const Problem& problem, const ParameterBox<Dimensions>& domain,
    const std::array<double, Dimensions>& tolerances, std::int64_t max_checks) {
  std::vector<WaitingBox<Dimensions>> stack{{domain, Dimensions - 1}};
  std::int64_t checks = 0;
  while (!stack.empty()) {
    if (max_checks > 0 && checks >= max_checks) return {TOUCHSTONE_UNDECIDED, {}};
    ++checks;
    const auto [box, last_split] = stack.back();
    stack.pop_back();
    if (!problem.may_vanish(box)) continue;
    const auto dimension = dimension_to_split(box, tolerances, last_split);
    if (!dimension) {
      if (problem.accepts(box)) return {TOUCHSTONE_YES, box};
      continue;
    }
    const UpwardInterval& side = box[*dimension];
    const double middle = middle_of(side);
    WaitingBox<Dimensions> upper{box, *dimension};
    WaitingBox<Dimensions> lower{box, *dimension};
    upper.box[*dimension] = {-middle, side.upper};
    lower.box[*dimension] = {side.minus_lower, middle};
    for (const auto& half : {upper, lower}) {
      if (*dimension == 0 || problem.reaches_domain(half.box)) stack.push_back(half);
    }
  }
  return {TOUCHSTONE_NO, {}};
}

// ---- The moving points --------------------------------------------------------------------------

using IntervalPoint = Vector<UpwardInterval>;
using IntervalPoints = std::array<IntervalPoint, moving_points>;

/// The points of a query at the times of t: displacement × t + start.
[[nodiscard]] inline IntervalPoints points_at(const Query& query, const UpwardInterval& t) {
  IntervalPoints result;
  for (std::size_t point = 0; point < moving_points; ++point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const UpwardInterval start(query.at(0, point, axis)), end(query.at(1, point, axis));
      result[point][axis] = (end - start) * t + start;
    }
  }
  return result;
}

/// The greatest Euclidean displacement of a point of the query, rounded to nearest by its caller.
[[nodiscard]] inline double greatest_displacement(const Query& query) {
  double greatest = 0.0;
  for (std::size_t point = 0; point < moving_points; ++point) {
    greatest = std::max(greatest, (point_of(query, 1, point) - point_of(query, 0, point)).norm());
  }
  return greatest;
}

}  // namespace touchstone::verify::published

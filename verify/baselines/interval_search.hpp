#pragma once

/// \file
/// The engine of IRF and UIRF: depth-first bisection of a box of parameters. ([snyder1992],
/// algorithm SOLVE.)
///
/// A box is dropped only if the problem proves that it holds no solution, and split boxes are
/// covered by their halves, so if all are dropped there is none. A box that is small on all axes
/// and that the problem accepts ends the search. Dimensions are split in turn; the lower half is
/// searched first. In one dimension boxes therefore come in ascending order, and the accepted one
/// begins no later than any solution; in several it is an arbitrary one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast/method.hpp"
#include "verify/baselines/intervals.hpp"

namespace touchstone::baselines {

template <std::size_t Dimensions>
using ParameterBox = std::array<Interval, Dimensions>;

/// Outcome of a search.
template <std::size_t Dimensions>
struct IntervalSearchResult {
  /// yes: a box was accepted. no: all were dropped. undecided: the checks ran out.
  fast::Verdict verdict;
  ParameterBox<Dimensions> box;  ///< with yes: the accepted one
  std::int64_t checks;           ///< boxes examined
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
    const Interval& side = box[dimension];
    const double middle = boost::numeric::median(side);
    const bool can_halve = side.lower() < middle && middle < side.upper();
    if (can_halve && boost::numeric::width(side) > tolerances[dimension]) return dimension;
  }
  return std::nullopt;
}

/// A box in the queue, and the dimension of its last split.
template <std::size_t Dimensions>
struct WaitingBox {
  ParameterBox<Dimensions> box;
  std::size_t last_split;
};

/// Searches a box. Problem has, as const functions of a ParameterBox:
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
    if (max_checks > 0 && checks >= max_checks) return {fast::Verdict::undecided, {}, checks};
    ++checks;
    const auto [box, last_split] = stack.back();
    stack.pop_back();
    if (!problem.may_vanish(box)) continue;
    const auto dimension = dimension_to_split(box, tolerances, last_split);
    if (!dimension) {
      if (problem.accepts(box)) return {fast::Verdict::yes, box, checks};
      continue;
    }
    const double middle = boost::numeric::median(box[*dimension]);
    WaitingBox<Dimensions> upper{box, *dimension};
    WaitingBox<Dimensions> lower{box, *dimension};
    upper.box[*dimension].assign(middle, box[*dimension].upper());
    lower.box[*dimension].assign(box[*dimension].lower(), middle);
    for (const auto& half : {upper, lower}) {
      if (*dimension == 0 || problem.reaches_domain(half.box)) stack.push_back(half);
    }
  }
  return {fast::Verdict::no, {}, checks};
}

}  // namespace touchstone::baselines

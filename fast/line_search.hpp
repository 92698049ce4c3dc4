#pragma once

/// \file
/// How far a line search may go: the step size up to which all stays at least p times as far apart as
/// it is at the start ([wang2021], algorithm 4, without its corrections).
///
/// **Theorem** (docs/theory.md, section 8.5). Let d > 0 be the distance at the start and s a double with
/// p d ≤ s < d. If nothing comes within s up to the time t, then all stays at least p d apart up to t. And the
/// first time at which something does is at least (d − s) / L > 0, where L is the greatest relative speed.
///
/// d is enclosed by neighbouring doubles (fast/distance.hpp), so s exists for all distances but the least
/// subnormal ones, and the time is enclosed to the step's toi_tolerance: its lower end is positive, unless
/// the time is below two of the least doubles. No tolerance, error estimate or further search is in
/// between; so no step is 0 without a reason that is told.

#include <cstdint>
#include <limits>
#include <vector>

#include "exact/query.hpp"
#include "fast/distance.hpp"
#include "fast/step.hpp"

namespace touchstone::fast {

/// Whose distance at the start counts.
enum class StartDistance : std::uint8_t {
  /// The least of the scene: no pair comes within p times that.
  of_scene,
  /// That of each pair itself, as in ipc-toolkit: none comes within p times its own. Pairs whose swept
  /// boxes are apart are not asked: they cannot touch, but may come nearer than that.
  of_pair,
};

enum class LineSearchStatus : std::uint8_t {
  whole,       ///< nothing limits the step
  limited,     ///< something does
  in_contact,  ///< something touches at the start; the step size is 0
  too_small,  ///< the step size, or a distance s as above, would be below the least doubles; it is 0
};

struct LineSearchOptions {
  Norm norm = Norm::l2;
  StartDistance start_distance = StartDistance::of_scene;
};

struct LineSearchLimit {
  LineSearchStatus status = LineSearchStatus::whole;
  /// In [0, t_max] of the step.
  double step_size = 0.0;
  /// The least distance at the start: of the scene, or else of `pairs`. Infinity: there are none.
  Distance distance{std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  /// limited: the pairs whose approach is the first, as in StepImpact. in_contact: those that touch at
  /// the start. too_small: those that do one or the other too early or too near for doubles.
  std::vector<StepCollision> pairs = {};
};

/// The greatest step size, rounded down by at most the step's toi_tolerance, up to which all stays at
/// least p times as far apart as at the start. Only p, the step and the options matter, but not the step's
/// separation.
/// \param p more than 0 and at most 1 − 2^-50.
/// \throws std::invalid_argument for another p.
[[nodiscard]] LineSearchLimit line_search_limit(const Step& step, double p,
                                                const LineSearchOptions& options = {});

}  // namespace touchstone::fast

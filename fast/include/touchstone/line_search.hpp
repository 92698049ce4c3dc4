#pragma once

/// \file
/// The limit of a line search: the step size up to which all primitives stay at least p times
/// as far apart as at the start ([wang2021], algorithm 4, without its corrections).
///
/// **Theorem** (docs/theory.md, section 8.5). Let d > 0 be the distance at the start and s a double
/// with p d ≤ s < d. If no pair comes within s up to the time t, all pairs stay at least p d apart
/// up to t. The first time at which a pair comes within s is at least (d − s) / L > 0, where L is
/// the greatest relative speed.
///
/// d is enclosed by neighbouring doubles (touchstone/distance.hpp), so s exists for all distances
/// but the least subnormal ones. The time is enclosed to the step's toi_tolerance, and its lower
/// end is positive unless the time is below two of the least doubles. There are no other tolerances
/// or corrections: a step size of 0 always comes with a status that explains it. The function is
/// thread-safe.

#include <cstdint>
#include <limits>
#include <vector>

#include "touchstone/distance.hpp"
#include "touchstone/query.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast {

/// The reference distance at the start.
enum class StartDistance : std::uint8_t {
  /// The least distance of the scene: no pair comes within p times that distance.
  of_scene,
  /// The distance of each pair, as in ipc-toolkit: no pair comes within p times its own. Pairs
  /// whose swept boxes are disjoint are not considered: they cannot collide, but may come closer
  /// than that.
  of_pair,
};

enum class LineSearchStatus : std::uint8_t {
  whole,       ///< the whole step is allowed
  limited,     ///< a pair limits the step
  in_contact,  ///< a pair is in contact at the start; the step size is 0
  too_small,   ///< the step size, or a distance s as above, would be below the least doubles; it is
               ///< 0
};

struct LineSearchOptions {
  Norm norm = Norm::l2;
  StartDistance start_distance = StartDistance::of_scene;
};

struct LineSearchLimit {
  LineSearchStatus status = LineSearchStatus::whole;
  /// In [0, t_max] of the step.
  double step_size = 0.0;
  /// The least distance at the start, of the scene or of `pairs` as the options say; infinity if
  /// there are no pairs.
  Distance distance{std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  /// limited: the pairs that limit the step first, as in StepImpact. in_contact: the pairs in
  /// contact at the start. too_small: the pairs that limit the step at a time or a distance too
  /// small for doubles.
  std::vector<StepCollision> pairs = {};
};

/// The greatest step size, rounded down by at most the step's toi_tolerance, up to which all
/// primitives stay at least p times as far apart as at the start. The separation of the step has no
/// effect.
/// \param p more than 0 and at most 1 − 2^-50.
/// \throws std::invalid_argument for another p.
[[nodiscard]] LineSearchLimit line_search_limit(const Step& step, double p,
                                                const LineSearchOptions& options = {});

}  // namespace touchstone::fast

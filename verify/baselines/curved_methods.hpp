#pragma once

/// \file
/// Methods for curves that others use, for comparison (docs/methods.md, section 14). All compute in
/// doubles without error bounds, and find a time of contact or none.
///
/// - *subdivision*: a piece is replaced by the chords of its points, from which they deviate by a
///   bounded distance. If the chords do not come within the sum of the greatest deviations of both
///   primitives, the piece is free; if that sum is below a tolerance they collide; else it is
///   halved. With `largest_deviation` the greater of the two takes the place of the sum.
/// - *sampling*: the distance at equally spaced times is compared with a tolerance.
/// - *advancement*: t grows by the distance over the greatest relative speed until the distance is
///   within a tolerance.

#include <memory>

#include "fast/method.hpp"

namespace touchstone::baselines {

// They promise nothing, answer polynomial curves at distance 0, and ignore all options but t_max.
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_method();
[[nodiscard]] std::unique_ptr<fast::Method> subdivision_largest_deviation_method();
[[nodiscard]] std::unique_ptr<fast::Method> sampling_method();
[[nodiscard]] std::unique_ptr<fast::Method> advancement_method();

}  // namespace touchstone::baselines

#pragma once

/// \file
/// What others do with curves, for comparison (docs/methods.md, section 14). All compute in doubles
/// without error bounds, and find a time of contact or none.
///
/// - *subdivision*: a piece is replaced by the chords of its points, from which they deviate by a
///   bounded distance. If the chords do not come within the sum of the greatest deviations of both
///   primitives, the piece is free; if that sum is below a tolerance they collide; else it is
///   halved. With `largest_deviation` the greater of the two takes the place of the sum.
/// - *sampling*: the distance at equally spaced times is compared with a tolerance.
/// - *advancement*: t grows by the distance over the greatest relative speed until the distance is
///   within a tolerance.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "touchstone/curved_query.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

struct CurvedMethod {
  std::string_view name;
  /// The time of contact of query i; nothing if it finds none. \pre without weights
  std::optional<double> (*solve)(Kind kind, const CurvedQueries& queries, std::size_t i);
};

/// subdivision, subdivision_largest_deviation, sampling, advancement.
[[nodiscard]] std::span<const CurvedMethod> curved_methods();

}  // namespace touchstone::baselines

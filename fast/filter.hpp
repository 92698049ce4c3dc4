#pragma once

/// \file
/// How far computed values of F may be from the truth, on each axis: the filter of
/// inclusion-based methods.

#include <array>
#include <cstdint>

#include "exact/query.hpp"

namespace touchstone::fast {

/// Where a filter comes from.
enum class ErrorModel : std::uint8_t {
  derived,    ///< filters/error_bounds.hpp: c · x_max, proved for the operations that run
  published,  ///< [wang2021]: a constant times max(x_max, 1)³
  /// The public Tight-Inclusion since 2022: the same constant times min(x_max, 1)³. No bound: F is
  /// linear in the coordinates, so that this is too small for x_max below about 0.9 and above about
  /// 1.2. For comparison only (docs/methods.md, section 2).
  released,
};

/// The filter on each axis, in units of the coordinates, for F − d and F + d with `min_separation`
/// d, or F itself if d is 0. `x_max`: on each axis, no coordinate is greater in magnitude; over one
/// query, or over a scene, whose filter then serves for all its queries. Infinite where overflow
/// could occur. \pre all arguments are finite and not negative.
[[nodiscard]] std::array<double, 3> error_filter(Kind kind, const std::array<double, 3>& x_max,
                                                 double min_separation,
                                                 ErrorModel model = ErrorModel::derived);

}  // namespace touchstone::fast

#pragma once

/// \file
/// The filter of inclusion-based methods: a bound, on each axis, of the error of computed
/// values of F. The function is thread-safe.

#include <array>
#include <cstdint>

#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The origin of a filter.
enum class ErrorModel : std::uint8_t {
  derived,  ///< touchstone/filters/error_bounds.hpp: c · x_max, proved for the operations that run
  published,  ///< [wang2021]: a constant times max(x_max, 1)³
  /// The public Tight-Inclusion since 2022: the same constant times min(x_max, 1)³. It is not a
  /// bound: F is linear in the coordinates, so it is too small for x_max below about 0.9 and above
  /// about 1.2. For comparison only (docs/methods.md, section 2).
  released,
  single_precision,  ///< as `derived`, for F computed in float
};

/// The filter on each axis, in units of the coordinates, for F − d and F + d with `distance`
/// d, or F itself if d is 0. `x_max` is the maximum magnitude of the coordinates on each axis, of
/// one query or of a scene; the filter of a scene holds for all its queries. Infinite if overflow
/// could occur. \pre all arguments are finite and not negative; floats for `single_precision`.
[[nodiscard]] std::array<double, 3> error_filter(Kind kind, const std::array<double, 3>& x_max,
                                                 double distance,
                                                 ErrorModel model = ErrorModel::derived);

}  // namespace touchstone::fast

#pragma once

/// \file
/// The vertices of a mesh in fixed point, for the stages in single precision
/// (fast/certified/stages/single_precision.hpp).
///
/// **Rounding.** Let o be the first vertex at t=0, and E the greatest |x − o| of any coordinate x,
/// at t=0 or t=1. With the unit h, the power of two for which E < 2^29 h ≤ 2 E, a coordinate
/// becomes the whole number next to (x − o) / h. Differences of two are at most 2^30 and do not
/// overflow.
///
/// **Error.** fl(x − o) errs by at most 2^-53 E < 2^-24 h, and division by h is exact, or the
/// result is below 2^-1000 and rounds to 0. At the end t < 1 of an interval, the computed position
/// errs by at most e (filters::Position), too. So a coordinate errs by at most (1/2 + 2^-24) h + e,
/// and a corner, the difference of two, by ε = (1 + 2^-23) h + 2 e in each coordinate.

#include <array>
#include <cstdint>

#include "fast/platform/large_array.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// x, y, z and an unused number, at both ends of an interval of times.
struct alignas(32) FixedPointVertex {
  std::array<std::int32_t, 4> start;
  std::array<std::int32_t, 4> end;
};

struct FixedPointVertices {
  /// Null if the scene or the distance is too large or too small for the stages.
  LargeArray<FixedPointVertex> vertices;
  /// An upper bound of D + ε in units of h.
  float distance = 0.0F;
  double unit = 1.0;   ///< h
  double error = 0.0;  ///< e

  /// The bound of D + ε for another D; infinity if that is too large for the stages.
  [[nodiscard]] float distance_for(double other) const;
};

/// The vertices at t=0 and at the time `end`, in (0,1]. Uses the threads of the caller's task
/// arena.
/// \param distance D, finite and not negative.
/// \pre The coordinates are finite.
[[nodiscard]] FixedPointVertices fixed_point_vertices(const Motion& vertices, double end,
                                                      double distance);

}  // namespace touchstone::fast

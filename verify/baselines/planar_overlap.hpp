#pragma once

/// \file
/// Does a segment meet a triangle in whose plane it lies? RP's fallback (docs/methods.md, section 9).
///
/// Both are projected along each coordinate axis and tested there, exactly. In a common plane they
/// meet iff they do in every projection: if they meet they do so in each; and some projection keeps
/// the plane two-dimensional, where it shows whether they meet.
///
/// **A defect, reproduced.** The weights of the point where they meet tell RP whether it is on the
/// triangle's boundary (a weight 0 or 1), which spoils its ray. Where the segment crosses the edge of
/// points 0 and 1, the weight of point 1 is written twice and that of point 2 keeps its preset of 0.5
/// instead of 0: the crossing passes for one of the interior.

#include <array>

#include "verify/baselines/exact_number.hpp"

namespace touchstone::baselines {

using ExactPoint = std::array<ExactNumber, 3>;

struct PlanarOverlap {
  bool overlaps = false;
  /// Of the segment's points where they meet, by the last projection that gives any.
  std::array<double, 2> segment_weights{0.5, 0.5};
  /// Likewise of the triangle's points; see the defect above.
  std::array<double, 3> triangle_weights{0.5, 0.5, 0.5};
};

/// \pre segment and triangle lie in a plane; either may be degenerate.
[[nodiscard]] PlanarOverlap planar_overlap(const std::array<ExactPoint, 2>& segment,
                                           const std::array<ExactPoint, 3>& triangle);

}  // namespace touchstone::baselines

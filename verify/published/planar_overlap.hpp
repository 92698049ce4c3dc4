#pragma once

/// \file
/// The overlap of a segment and a triangle in one plane: RP's fallback (rp.cpp).
///
/// Both are projected along each coordinate axis and tested there, exactly. In a common plane they
/// meet iff they meet in every projection: if they meet, their projections meet; and some
/// projection is injective on the plane.
///
/// **A reproduced defect.** RP uses the weights of the common point to see whether it is on the
/// triangle's boundary (a weight 0 or 1), which invalidates its ray. If the segment crosses the
/// edge of points 0 and 1, the weight of point 1 is written twice and that of point 2 keeps its
/// preset of 0.5 instead of 0: the crossing is treated as one of the interior.

#include <array>

#include "verify/published/exact_number.hpp"

namespace touchstone::verify::published {

using ExactPoint = std::array<ExactNumber, 3>;

struct PlanarOverlap {
  bool overlaps = false;
  /// Weights of the segment's points at the common point, by the last projection that yields any.
  std::array<double, 2> segment_weights{0.5, 0.5};
  /// Weights of the triangle's points, likewise; see the defect above.
  std::array<double, 3> triangle_weights{0.5, 0.5, 0.5};
};

/// \pre segment and triangle lie in a plane; either may be degenerate.
[[nodiscard]] PlanarOverlap planar_overlap(const std::array<ExactPoint, 2>& segment,
                                           const std::array<ExactPoint, 3>& triangle);

}  // namespace touchstone::verify::published

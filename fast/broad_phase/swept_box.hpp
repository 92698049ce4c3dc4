#pragma once

/// \file
/// Swept boxes in double, for exact decisions where boxes in float are too coarse.
///
/// Their bounds are minima and maxima of coordinates, so bounds and comparisons are exact.

#include <array>
#include <limits>

#include "fast/broad_phase/primitive_groups.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// An axis-aligned closed box. By default it is empty and overlaps no other.
struct SweptBox {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  std::array<double, 3> lower{infinity, infinity, infinity};
  std::array<double, 3> upper{-infinity, -infinity, -infinity};

  /// True if the boxes have a common point.
  [[nodiscard]] bool overlaps(const SweptBox& other) const;

  friend bool operator==(const SweptBox&, const SweptBox&) = default;
};

/// The box of all positions of a primitive's vertices at t=0 and at t=1.
[[nodiscard]] SweptBox swept_box(const Motion& vertices, const Primitive& primitive);

/// The box with its bounds moved outwards by a distance ≥ 0, each rounded *inwards*, to the nearest
/// double that is not beyond the exact sum. It overlaps a box of doubles iff the exact one does: a
/// double is at most the sum iff it is at most the greatest double up to the sum. The empty box
/// stays empty.
[[nodiscard]] SweptBox widened(const SweptBox& box, double distance);

/// True if the swept boxes of two primitives are within the distance.
[[nodiscard]] bool are_within_distance(const Motion& vertices, const Primitive& a,
                                       const Primitive& b, double distance);

}  // namespace touchstone::fast

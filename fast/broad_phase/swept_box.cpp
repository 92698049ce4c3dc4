#include "fast/broad_phase/swept_box.hpp"

#include <algorithm>
#include <cmath>

namespace touchstone::fast {
namespace {

/// The greatest double that is not above bound + distance. An infinite bound is unchanged.
double sum_rounded_down(double bound, double distance) {
  const double sum = bound + distance;
  if (sum == SweptBox::infinity) return std::min(bound, std::numeric_limits<double>::max());
  // Subtracting the greater summand again is exact [dekker1971], so this compares sum and exact
  // sum.
  const bool rounded_up =
      std::abs(bound) >= distance ? sum - bound > distance : sum - distance > bound;
  return rounded_up ? std::nextafter(sum, -SweptBox::infinity) : sum;
}

}  // namespace

bool SweptBox::overlaps(const SweptBox& other) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lower[axis] > other.upper[axis] || other.lower[axis] > upper[axis]) return false;
  }
  return true;
}

SweptBox swept_box(const Motion& vertices, const Primitive& primitive) {
  SweptBox box;
  for (const std::int32_t index : primitive) {
    const MovingVertex& vertex = vertices[static_cast<std::size_t>(index)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min({box.lower[axis], vertex.start[axis], vertex.end[axis]});
      box.upper[axis] = std::max({box.upper[axis], vertex.start[axis], vertex.end[axis]});
    }
  }
  return box;
}

SweptBox widened(const SweptBox& box, double distance) {
  SweptBox result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = -sum_rounded_down(-box.lower[axis], distance);
    result.upper[axis] = sum_rounded_down(box.upper[axis], distance);
  }
  return result;
}

bool are_within_distance(const Motion& vertices, const Primitive& a, const Primitive& b,
                         double distance) {
  return widened(swept_box(vertices, a), distance).overlaps(swept_box(vertices, b));
}

}  // namespace touchstone::fast

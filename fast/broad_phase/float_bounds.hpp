#pragma once

/// \file
/// Where vertices are, in float, rounded outwards: what the boxes of the broad phase are made of.
///
/// Coordinates are multiplied by one power of two, so that they fit into float whatever their unit, and
/// rounded down and up. Both are monotone. So where a rounded-down number is greater than a rounded-up
/// one, the coordinates are in that order too: boxes that are apart in float are apart.
///
/// The converse holds where no coordinate was rounded, as where all of them are floats, or
/// wherever a comparison is decided by more than the rounding. Let a' be the greatest float up to a, and
/// b' the least from b on, and let x⁺ be the float after x. Then a < a'⁺, and b is greater than
/// the float before b'. So a'⁺⁺ ≤ b' implies a < b: two floats farther on, the comparison is sure.
///
/// **Part of a step.** The end of an interval [0, t] may be before 1. Where a point is then is
/// computed with an error of at most e (filters::Position), so it is in [p − e, p + e]. The bound e
/// is greater than what the rounding of p ∓ 2e and of scaled coordinates adds. So these are on
/// either side, and are rounded to float as coordinates are.
///
/// The scale is 1 for scenes of a usual size. Else it brings the greatest coordinate to between 1 and 2,
/// so nothing overflows; what underflows is rounded outwards as well.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "fast/mesh.hpp"

namespace touchstone::fast {

/// The place of a float among all floats, of which −0 is the one before 0; and the float there.
[[nodiscard]] inline std::int32_t order_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return bits ^ ((bits >> 31) & std::numeric_limits<std::int32_t>::max());
}
[[nodiscard]] inline float float_at(std::int32_t order) {
  return std::bit_cast<float>(order ^ ((order >> 31) & std::numeric_limits<std::int32_t>::max()));
}

/// The float after x; infinity has none and stays. \pre x is a number.
[[nodiscard]] inline float float_after(float x) {
  if (x == 0.0F) return std::numeric_limits<float>::denorm_min();
  if (x == std::numeric_limits<float>::infinity()) return x;
  return float_at(order_of(x) + 1);
}

/// The float before x, likewise.
[[nodiscard]] inline float float_before(float x) { return -float_after(-x); }

/// The greatest float that is not above x; of minus infinity, itself.
[[nodiscard]] float rounded_down(double x);
/// The least float that is not below x.
[[nodiscard]] inline float rounded_up(double x) { return -rounded_down(-x); }

/// x, y, z and something else, side by side: compilers make one vector of it.
using FloatRow = float __attribute__((vector_size(16)));

[[nodiscard]] inline FloatRow least(const FloatRow& a, const FloatRow& b) { return a < b ? a : b; }
[[nodiscard]] inline FloatRow greatest(const FloatRow& a, const FloatRow& b) {
  return a > b ? a : b;
}

/// A vertex at both ends of an interval of times, rounded down and up.
struct alignas(64) VertexBounds {
  std::array<FloatRow, 2> lower;
  std::array<FloatRow, 2> upper;
};

class FloatBounds {
 public:
  /// Of the vertices at t=0 and at the time `end`, a power of two from 2^-52 to 1. Uses the threads
  /// of the task arena that it is called in.
  /// \pre their coordinates are finite.
  explicit FloatBounds(const MovingVertices& vertices, double end = 1.0);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const VertexBounds& operator[](std::size_t i) const { return bounds_[i]; }
  /// Are all bounds the coordinates themselves, times the scale? Not asked before t=1.
  [[nodiscard]] bool are_exact() const { return exact_; }
  /// A distance, times what coordinates are multiplied with, rounded up and down; perhaps to infinity, and
  /// to the greatest float.
  [[nodiscard]] float scaled_up(double distance) const;
  [[nodiscard]] float scaled_down(double distance) const;

 private:
  /// Are the bounds of that vertex exact?
  bool set(VertexBounds& bounds, const MovingVertex& vertex, double end) const;

  std::size_t size_;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  std::unique_ptr<VertexBounds[]> bounds_;
  double scale_ = 1.0;  ///< a power of two
  bool exact_ = true;
};

}  // namespace touchstone::fast

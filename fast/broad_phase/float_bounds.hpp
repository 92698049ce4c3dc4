#pragma once

/// \file
/// Where vertices are, in float, rounded outwards: the numbers that the boxes of the broad phase are made of.
///
/// Boxes are only compared. So instead of a coordinate any increasing function of it will do, and one
/// is chosen that keeps coordinates of every size apart.
///
/// **Places.** Let a coordinate be ±2^(i−1074) (1+f), 0 ≤ f < 1, and N = 2^23. Its place is ±n(i+f), where
///
///     n(y) = N + y N/64                   for y < 64 j,
///            N + (y − 63 j) N             for 64 j ≤ y < 64 j + 192, the *window*,
///            190 N + y N/64               for y ≥ 64 j + 192,
///
/// and that of 0 is 0. n is increasing and continuous. All places are below 224 N, and whole numbers up to
/// there are the places of the floats among all floats, so coordinates are rounded to the floats at the
/// next whole places. In the window the float at n is the coordinate itself times a power of two, and
/// rounding keeps 24 digits; elsewhere it keeps 18. j is chosen such that most coordinates are in the
/// window. It depends on the vertices alone.
///
/// Where a rounded-down number is greater than a rounded-up one, the coordinates are in that order too:
/// boxes that are apart in float are apart.
///
/// **With a distance** d, boxes that are d apart are to overlap. So d/2 is taken from lower bounds and added
/// to upper ones before they are rounded. (Where d is an odd multiple of the least double, its halves
/// are the two multiples around d/2.) Such a sum is rounded to a double, by 2^-53 of it at most, and
/// not at all where it is subnormal. That moves its place by much less than 1, and bounds are moved
/// outwards by 1 for it.
///
/// **Sure comparisons.** Let a lower bound x have the float at L, and an upper bound y that at U. Then x has
/// a place below L + 1, or below L + 2 + 2^-20 with a distance, and that of y is above U − 1 or
/// U − 2 − 2^-20. So L + 5 ≤ U implies x < y: `sure_floats` farther on, a comparison is sure. If d = 0 and
/// no coordinate was rounded, all are.
///
/// **Part of a step.** The end of an interval [0, t] may be before 1. Where a point is then is
/// computed with an error of at most e (filters::Position), so it is in [p − e, p + e]. The bound e
/// is greater than what the rounding of p ∓ 2e adds. So these are on either side, and are rounded to
/// float as coordinates are.

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

/// By as many floats the bounds of a lower and an upper coordinate have to differ for these to be in that
/// order for sure.
inline constexpr std::int32_t sure_floats = 5;

/// The float that is as many after x, and not −0. \pre x is a bound.
[[nodiscard]] inline float surely_after(float x) {
  // Of −0, 0 remains.
  return float_at(order_of(x + 0.0F) + sure_floats);
}
[[nodiscard]] inline float surely_before(float x) { return -surely_after(-x); }

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
  /// \param distance d, finite and not negative.
  /// \pre their coordinates are finite.
  explicit FloatBounds(const MovingVertices& vertices, double end = 1.0, double distance = 0.0);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const VertexBounds& operator[](std::size_t i) const { return bounds_[i]; }
  /// Is every comparison of a lower with an upper bound that of the coordinates? Not asked before t=1.
  [[nodiscard]] bool are_exact() const { return exact_; }

 private:
  std::size_t size_;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  std::unique_ptr<VertexBounds[]> bounds_;
  bool exact_ = true;
};

}  // namespace touchstone::fast

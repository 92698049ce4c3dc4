#pragma once

/// \file
/// Where vertices are, in float: the numbers that the boxes of the broad phase are made of.
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
/// and that of 0 is 0. n is increasing. All places are below 224 N, and whole numbers up to there are the
/// places of floats in the order of all floats. A coordinate is rounded towards 0 to the float at a whole
/// place. In the window that is the coordinate itself times a power of two, with 24 digits; elsewhere it
/// has 18. j is chosen such that most coordinates are in the window. It depends on the vertices alone.
///
/// **Comparisons.** Let h and k be the halves of a distance d. (Where d is an odd multiple of the least
/// double, these are the two multiples around d/2.) A lower bound is the float of fl(x − h), an upper one that of
/// fl(y + k), where fl rounds to a double. All of these roundings are monotone. So a lower bound
/// greater than an upper one implies x − h > y + k: boxes that are apart in float are more than d apart. A
/// lower bound less than an upper one implies x − h < y + k: all other comparisons are sure as well, but
/// those of equal floats. If d = 0 and no coordinate was rounded, these are sure too.
///
/// **Part of a step.** The end of an interval [0, t] may be before 1. Where a point is then is
/// computed with an error of at most e (filters::Position), so it is in [p − e, p + e]. The bound e
/// is greater than what the rounding of p ∓ 2e adds. So these are on either side, and take the place of
/// x and y.

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

/// x, y, z and something else, side by side: compilers make one vector of it.
using FloatRow = float __attribute__((vector_size(16)));

[[nodiscard]] inline FloatRow least(const FloatRow& a, const FloatRow& b) { return a < b ? a : b; }
[[nodiscard]] inline FloatRow greatest(const FloatRow& a, const FloatRow& b) {
  return a > b ? a : b;
}

/// A vertex at both ends of an interval of times: lower and upper bounds.
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
  /// Are comparisons of equal bounds sure too? Not asked before t=1.
  [[nodiscard]] bool are_exact() const { return exact_; }

 private:
  std::size_t size_;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): an array of its own that nothing fills with zeros
  std::unique_ptr<VertexBounds[]> bounds_;
  bool exact_ = true;
};

}  // namespace touchstone::fast

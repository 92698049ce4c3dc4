#pragma once

/// \file
/// Bounds of coordinates in float, for the boxes of the broad phase.
///
/// Boxes are only compared. A coordinate may therefore be replaced by any increasing function of
/// it; the chosen one keeps coordinates of every size apart.
///
/// **Places.** Let a coordinate be ±2^(i−1074) (1+f), 0 ≤ f < 1, and N = 2^23. Its place is
/// ±n(i+f), where
///
///     n(y) = N + y N/64                   for y < 64 j,
///            N + (y − 63 j) N             for 64 j ≤ y < 64 j + 192, the *window*,
///            190 N + y N/64               for y ≥ 64 j + 192,
///
/// and that of 0 is 0. n is increasing. All places are below 224 N, and the whole numbers up to
/// there number the floats in their order. A coordinate is rounded towards 0 to the float at a
/// whole place. In the window this float is the coordinate itself times a power of two, with 24
/// digits; elsewhere it has 18. j is chosen such that most coordinates are in the window. It
/// depends on the vertices alone.
///
/// **Comparisons.** Let h and k be the halves of a distance d. (If d is an odd multiple of the
/// least double, these are the two multiples around d/2.) A lower bound is the float of fl(x − h),
/// an upper one that of fl(y + k), where fl rounds to a double. All of these roundings are
/// monotone. So a lower bound greater than an upper one implies x − h > y + k: boxes that are apart
/// in float are more than d apart. A lower bound less than an upper one implies x − h < y + k:
/// boxes that overlap without their bounds are at most d apart. Only equal floats leave the
/// comparison undecided, unless d = 0 and no coordinate was rounded.
///
/// **Reaches.** Vertices may have reaches besides. With those of two, ρ and σ, boxes that are apart
/// in float are more than d + ρ + σ apart, or by a few ulps more: h + ρ and k + σ are then the
/// parts, each enlarged by 2^-50 of itself, which covers its rounding and one of the sum.
///
/// **Part of a step.** The end t of an interval [0, t] may be less than 1. The position of a point
/// at t is computed with an error of at most e (filters::Position), so it is in [p − e, p + e]. The
/// bound e exceeds the rounding error of p ∓ 2e. The computed p ∓ 2e are therefore on either side
/// of the position, and replace x and y.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "fast/platform/large_array.hpp"
#include "touchstone/mesh.hpp"

namespace touchstone::fast {

/// The place of a float in the order of all floats, with −0 directly before 0; and its inverse.
[[nodiscard]] inline std::int32_t order_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return bits ^ ((bits >> 31) & std::numeric_limits<std::int32_t>::max());
}
[[nodiscard]] inline float float_at(std::int32_t order) {
  return std::bit_cast<float>(order ^ ((order >> 31) & std::numeric_limits<std::int32_t>::max()));
}

/// The float after x; infinity for infinity. \pre x is a number.
[[nodiscard]] inline float float_after(float x) {
  if (x == 0.0F) return std::numeric_limits<float>::denorm_min();
  if (x == std::numeric_limits<float>::infinity()) return x;
  return float_at(order_of(x) + 1);
}

/// The float before x, likewise.
[[nodiscard]] inline float float_before(float x) { return -float_after(-x); }

/// x, y, z and an unused number, as one vector.
using FloatRow = float __attribute__((vector_size(16)));

[[nodiscard]] inline FloatRow least(const FloatRow& a, const FloatRow& b) { return a < b ? a : b; }
[[nodiscard]] inline FloatRow greatest(const FloatRow& a, const FloatRow& b) {
  return a > b ? a : b;
}

/// Lower and upper bounds of a vertex at both ends of an interval of times.
struct alignas(64) VertexBounds {
  std::array<FloatRow, 2> lower;
  std::array<FloatRow, 2> upper;
};

class FloatBounds {
 public:
  /// Bounds of the vertices at t=0 and at the time `end`, a power of two from 2^-52 to 1. Uses the
  /// threads of the caller's task arena.
  /// \param distance d, finite and not negative.
  /// \param reaches Those of the vertices, not negative; or empty: all are 0.
  /// \pre The coordinates are finite.
  explicit FloatBounds(const Motion& vertices, double end = 1.0, double distance = 0.0,
                       std::span<const double> reaches = {});

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const VertexBounds& operator[](std::size_t i) const { return bounds_[i]; }
  /// True if comparisons of equal bounds are certain, too. Only for the end t=1.
  [[nodiscard]] bool are_exact() const { return exact_; }

 private:
  std::size_t size_;
  LargeArray<VertexBounds> bounds_;
  bool exact_ = true;
};

}  // namespace touchstone::fast

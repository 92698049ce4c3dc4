#pragma once

/// \file
/// What the AVX2 and the AVX-512 kernel share: work on halves of four lanes. All of it is templates
/// on a type local to the including file, so that this code is too (see box_kernel_on_lanes.hpp).

#include <immintrin.h>

#include <cstddef>

namespace touchstone::fast {

/// One coordinate of four points, which stand one after the other, x, y, z each.
template <class Local, std::size_t axis>
__m256d coordinate_avx(const double* points) {
  // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3
  const __m256d first = _mm256_loadu_pd(points), second = _mm256_loadu_pd(points + 4),
                third = _mm256_loadu_pd(points + 8);
  if constexpr (axis == 0) {
    const __m256d mixed =
        _mm256_blend_pd(_mm256_blend_pd(first, second, 0b0100), third, 0b0010);  // x0 x3 x2 x1
    return _mm256_permute4x64_pd(mixed, 0 | 3 << 2 | 2 << 4 | 1 << 6);
  } else if constexpr (axis == 1) {
    const __m256d mixed =
        _mm256_blend_pd(_mm256_blend_pd(first, second, 0b1001), third, 0b0100);  // y1 y0 y3 y2
    return _mm256_permute4x64_pd(mixed, 1 | 0 << 2 | 3 << 4 | 2 << 6);
  } else {
    const __m256d mixed =
        _mm256_blend_pd(_mm256_blend_pd(first, second, 0b0010), third, 0b1001);  // z2 z1 z0 z3
    return _mm256_permute4x64_pd(mixed, 2 | 1 << 2 | 0 << 4 | 3 << 6);
  }
}

/// The greatest magnitude in two vectors.
template <class Local>
double magnitude_avx(__m256d a, __m256d b) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  const __m256d four = _mm256_max_pd(_mm256_andnot_pd(sign, a), _mm256_andnot_pd(sign, b));
  const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
}

/// The bounding box of corner values: its least ends on the three axes in one vector, and its
/// greatest.
template <class Local>
struct AxisBoundsAvx {
  __m256d least;     ///< on x, y, z, z
  __m256d greatest;  ///< likewise

  /// From the lesser and the greater of both halves' lanes, on each axis.
  static AxisBoundsAvx from(__m256d least_x, __m256d least_y, __m256d least_z, __m256d greatest_x,
                            __m256d greatest_y, __m256d greatest_z) {
    const auto min = [](__m256d a, __m256d b) { return _mm256_min_pd(a, b); };
    const auto max = [](__m256d a, __m256d b) { return _mm256_max_pd(a, b); };
    return {across(least_x, least_y, least_z, min),
            across(greatest_x, greatest_y, greatest_z, max)};
  }

  /// Is the box beyond separation and filter, on some axis?
  [[nodiscard]] bool are_beyond(const double* filter, double separation) const {
    const __m256d f = _mm256_loadu_pd(filter), d = _mm256_set1_pd(separation);
    const __m256d above = _mm256_cmp_pd(_mm256_sub_pd(least, d), f, _CMP_GT_OQ);
    const __m256d below = _mm256_cmp_pd(_mm256_add_pd(greatest, d), negated(f), _CMP_LT_OQ);
    return _mm256_movemask_pd(_mm256_or_pd(above, below)) != 0;
  }

  /// Is the box within separation and filter, on all axes?
  [[nodiscard]] bool are_within(const double* filter, double separation) const {
    const __m256d f = _mm256_loadu_pd(filter), d = _mm256_set1_pd(separation);
    const __m256d not_above = _mm256_cmp_pd(_mm256_sub_pd(greatest, d), f, _CMP_LE_OQ);
    const __m256d not_below = _mm256_cmp_pd(_mm256_add_pd(least, d), negated(f), _CMP_GE_OQ);
    return _mm256_movemask_pd(_mm256_and_pd(not_above, not_below)) == 0b1111;
  }

  /// The longest side.
  [[nodiscard]] double width() const {
    const __m256d widths = _mm256_sub_pd(greatest, least);
    const __m128d two =
        _mm_max_pd(_mm256_castpd256_pd128(widths), _mm256_extractf128_pd(widths, 1));
    return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
  }

 private:
  static __m256d negated(__m256d x) { return _mm256_xor_pd(x, _mm256_set1_pd(-0.0)); }

  /// `extreme` over the lanes of x, of y and of z.
  template <class Extreme>
  static __m256d across(__m256d x, __m256d y, __m256d z, const Extreme& extreme) {
    const __m256d xy = extreme(_mm256_unpacklo_pd(x, y), _mm256_unpackhi_pd(x, y));
    const __m256d zz = extreme(_mm256_unpacklo_pd(z, z), _mm256_unpackhi_pd(z, z));
    return extreme(_mm256_permute2f128_pd(xy, zz, 0x20), _mm256_permute2f128_pd(xy, zz, 0x31));
  }
};

}  // namespace touchstone::fast

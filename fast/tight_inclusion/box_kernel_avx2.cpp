// The kernel in AVX2. It is compiled for these instructions and called only on processors that have
// them.
//
// There is no kernel in AVX-512: lanes move only within halves of four, for which one wide register
// is not faster. On a processor with both (Zen 4) it took 1.08 to 1.24 times as long on the public
// data.

#include <immintrin.h>

#include <cstddef>

#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"

namespace touchstone::fast {
namespace {

/// One coordinate of four consecutive points of x, y and z.
template <std::size_t axis>
__m256d of_axis(const double* points) {
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
double greatest_magnitude(__m256d a, __m256d b) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  const __m256d four = _mm256_max_pd(_mm256_andnot_pd(sign, a), _mm256_andnot_pd(sign, b));
  const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
  return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
}

/// The bounding box of corner values: its least ends on the three axes in one vector, and its
/// greatest.
struct AxisBounds {
  __m256d least;     ///< on x, y, z, z
  __m256d greatest;  ///< likewise

  /// Bounds from the lesser and the greater of both halves' lanes, on each axis.
  static AxisBounds from(__m256d least_x, __m256d least_y, __m256d least_z, __m256d greatest_x,
                         __m256d greatest_y, __m256d greatest_z) {
    const auto min = [](__m256d a, __m256d b) { return _mm256_min_pd(a, b); };
    const auto max = [](__m256d a, __m256d b) { return _mm256_max_pd(a, b); };
    return {across(least_x, least_y, least_z, min),
            across(greatest_x, greatest_y, greatest_z, max)};
  }

  /// True if the box is beyond separation and filter on some axis.
  [[nodiscard]] bool are_beyond(const double* filter, double separation) const {
    const __m256d f = _mm256_loadu_pd(filter), d = _mm256_set1_pd(separation);
    const __m256d above = _mm256_cmp_pd(_mm256_sub_pd(least, d), f, _CMP_GT_OQ);
    const __m256d below = _mm256_cmp_pd(_mm256_add_pd(greatest, d), negated(f), _CMP_LT_OQ);
    return _mm256_movemask_pd(_mm256_or_pd(above, below)) != 0;
  }

  /// True if the box is within separation and filter on all axes.
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

/// Eight lanes in two registers, one half in each.
struct Lanes {
  static constexpr int digits = 53;

  __m256d low;
  __m256d high;

  static Lanes twice(double a, double b, double c, double d) {
    const __m256d four = _mm256_setr_pd(a, b, c, d);
    return {four, four};
  }
  static Lanes twice(const double* values) {
    const __m256d four = _mm256_loadu_pd(values);
    return {four, four};
  }
  static Lanes halves(double a, double b) { return {_mm256_set1_pd(a), _mm256_set1_pd(b)}; }
  template <std::size_t axis>
  static Lanes coordinate(const double* points) {
    return {of_axis<axis>(points), of_axis<axis>(points + 12)};
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return {_mm256_add_pd(a.low, b.low), _mm256_add_pd(a.high, b.high)};
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return {_mm256_sub_pd(a.low, b.low), _mm256_sub_pd(a.high, b.high)};
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return {_mm256_mul_pd(a.low, b.low), _mm256_mul_pd(a.high, b.high)};
  }

  template <int a, int b, int c, int d>
  [[nodiscard]] Lanes shuffled() const {
    constexpr int order = a | b << 2 | c << 4 | d << 6;
    return {_mm256_permute4x64_pd(low, order), _mm256_permute4x64_pd(high, order)};
  }

  void store(double* values) const {
    _mm256_storeu_pd(values, low);
    _mm256_storeu_pd(values + 4, high);
  }

  [[nodiscard]] bool are_finite() const {
    const __m256d zero = _mm256_setzero_pd();
    const __m256d is_zero =
        _mm256_and_pd(_mm256_cmp_pd(_mm256_sub_pd(low, low), zero, _CMP_EQ_OQ),
                      _mm256_cmp_pd(_mm256_sub_pd(high, high), zero, _CMP_EQ_OQ));
    return _mm256_movemask_pd(is_zero) == 0b1111;
  }
  [[nodiscard]] double magnitude() const { return greatest_magnitude(low, high); }

  static AxisBounds bounds(const Lanes& x, const Lanes& y, const Lanes& z) {
    return AxisBounds::from(_mm256_min_pd(x.low, x.high), _mm256_min_pd(y.low, y.high),
                            _mm256_min_pd(z.low, z.high), _mm256_max_pd(x.low, x.high),
                            _mm256_max_pd(y.low, y.high), _mm256_max_pd(z.low, z.high));
  }
};

}  // namespace

extern const BoxKernel avx2_box_kernel;
const BoxKernel avx2_box_kernel = BoxKernelOnLanes<Lanes>::kernel(InstructionSet::avx2);

}  // namespace touchstone::fast

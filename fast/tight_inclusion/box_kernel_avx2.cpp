// The kernel in AVX2; compiled for it, and called on processors that have it only.

#include <immintrin.h>

#include "fast/platform/avx_halves.hpp"
#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"

namespace touchstone::fast {
namespace {

/// Eight lanes in two registers, a half each.
struct Lanes {
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
    return {coordinate_avx<Lanes, axis>(points), coordinate_avx<Lanes, axis>(points + 12)};
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
  [[nodiscard]] double magnitude() const { return magnitude_avx<Lanes>(low, high); }

  static AxisBoundsAvx<Lanes> bounds(const Lanes& x, const Lanes& y, const Lanes& z) {
    return AxisBoundsAvx<Lanes>::from(_mm256_min_pd(x.low, x.high), _mm256_min_pd(y.low, y.high),
                                      _mm256_min_pd(z.low, z.high), _mm256_max_pd(x.low, x.high),
                                      _mm256_max_pd(y.low, y.high), _mm256_max_pd(z.low, z.high));
  }
};

}  // namespace

extern const BoxKernel avx2_box_kernel;
const BoxKernel avx2_box_kernel = BoxKernelOnLanes<Lanes>::kernel(InstructionSet::avx2);

}  // namespace touchstone::fast

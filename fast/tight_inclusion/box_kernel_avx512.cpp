// The kernel in AVX-512 (its foundation, F); compiled for it, and called on processors that have it
// only.

#include <immintrin.h>

#include "fast/platform/avx_halves.hpp"
#include "fast/tight_inclusion/box_kernel_on_lanes.hpp"

namespace touchstone::fast {
namespace {

/// Eight lanes in one register.
struct Lanes {
  __m512d all;

  static Lanes twice(double a, double b, double c, double d) {
    return {_mm512_broadcast_f64x4(_mm256_setr_pd(a, b, c, d))};
  }
  static Lanes twice(const double* values) {
    return {_mm512_broadcast_f64x4(_mm256_loadu_pd(values))};
  }
  static Lanes halves(double a, double b) {
    return {_mm512_insertf64x4(_mm512_set1_pd(a), _mm256_set1_pd(b), 1)};
  }
  template <std::size_t axis>
  static Lanes coordinate(const double* points) {
    const __m256d low = coordinate_avx<Lanes, axis>(points);
    const __m256d high = coordinate_avx<Lanes, axis>(points + 12);
    return {_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1)};
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {_mm512_add_pd(a.all, b.all)}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {_mm512_sub_pd(a.all, b.all)}; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return {_mm512_mul_pd(a.all, b.all)}; }

  template <int a, int b, int c, int d>
  [[nodiscard]] Lanes shuffled() const {
    return {_mm512_permutex_pd(all, a | b << 2 | c << 4 | d << 6)};
  }

  void store(double* values) const { _mm512_storeu_pd(values, all); }

  [[nodiscard]] bool are_finite() const {
    const __m512d difference = _mm512_sub_pd(all, all);
    return _mm512_cmp_pd_mask(difference, _mm512_setzero_pd(), _CMP_EQ_OQ) == 0xFF;
  }
  [[nodiscard]] __m256d least_of_halves() const {
    return _mm256_min_pd(_mm512_castpd512_pd256(all), _mm512_extractf64x4_pd(all, 1));
  }
  [[nodiscard]] __m256d greatest_of_halves() const {
    return _mm256_max_pd(_mm512_castpd512_pd256(all), _mm512_extractf64x4_pd(all, 1));
  }
  [[nodiscard]] double magnitude() const {
    return magnitude_avx<Lanes>(least_of_halves(), greatest_of_halves());
  }

  static AxisBoundsAvx<Lanes> bounds(const Lanes& x, const Lanes& y, const Lanes& z) {
    return AxisBoundsAvx<Lanes>::from(x.least_of_halves(), y.least_of_halves(), z.least_of_halves(),
                                      x.greatest_of_halves(), y.greatest_of_halves(),
                                      z.greatest_of_halves());
  }
};

}  // namespace

extern const BoxKernel avx512_box_kernel;
const BoxKernel avx512_box_kernel = BoxKernelOnLanes<Lanes>::kernel(InstructionSet::avx512);

}  // namespace touchstone::fast

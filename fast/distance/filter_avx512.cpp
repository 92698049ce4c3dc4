// The filter of distances in AVX-512 (its foundation, F), eight queries at a time; compiled for it, and
// called on processors that have it only.

#include <immintrin.h>

#include "fast/distance/filter_on_lanes.hpp"

namespace touchstone::fast {
namespace {

struct Mask {
  __mmask8 set;

  static Mask all() { return {0xFF}; }
  [[nodiscard]] unsigned bits() const { return set; }

  friend Mask operator&(Mask a, Mask b) { return {static_cast<__mmask8>(a.set & b.set)}; }
  friend Mask operator|(Mask a, Mask b) { return {static_cast<__mmask8>(a.set | b.set)}; }
};

struct Value {
  __m512d x;

  Value() = default;
  explicit Value(double value) : x(_mm512_set1_pd(value)) {}
  explicit Value(__m512d value) : x(value) {}
  static Value load(const double* from) { return Value(_mm512_loadu_pd(from)); }
  void store(double* to) const { _mm512_storeu_pd(to, x); }

  friend Value operator+(const Value& a, const Value& b) { return Value(_mm512_add_pd(a.x, b.x)); }
  friend Value operator-(const Value& a, const Value& b) { return Value(_mm512_sub_pd(a.x, b.x)); }
  friend Value operator*(const Value& a, const Value& b) { return Value(_mm512_mul_pd(a.x, b.x)); }
  friend Value operator/(const Value& a, const Value& b) { return Value(_mm512_div_pd(a.x, b.x)); }
  friend Mask operator<(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_LT_OQ)};
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_GT_OQ)};
  }
  friend Mask operator>=(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_GE_OQ)};
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend Value abs(const Value& a) { return Value(_mm512_abs_pd(a.x)); }
  friend Value sqrt(const Value& a) { return Value(_mm512_sqrt_pd(a.x)); }
  friend Value select(const Mask& mask, const Value& a, const Value& b) {
    return Value(_mm512_mask_blend_pd(mask.set, b.x, a.x));
  }
  /// a · b − product, in one rounding of what is exact.
  friend Value product_error(const Value& a, const Value& b, const Value& product) {
    return Value(_mm512_fmsub_pd(a.x, b.x, product.x));
  }
};

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;
  static constexpr std::size_t width = 8;
};

}  // namespace

extern const DistanceKernel avx512_distance_kernel;
const DistanceKernel avx512_distance_kernel = distance_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast

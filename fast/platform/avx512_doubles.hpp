#pragma once

/// \file
/// Eight doubles in a register of AVX-512's foundation and FMA, and masks of them, for the
/// kernels. They are local to the including file, so that no other file links code for these
/// instructions.

#include <immintrin.h>

#include <array>

#include "fast/platform/avx_rows.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct Mask {
  __mmask8 set;

  static Mask none() { return {0}; }
  static Mask all() { return {0xFF}; }
  [[nodiscard]] unsigned bits() const { return set; }

  friend Mask operator&(Mask a, Mask b) { return {static_cast<__mmask8>(a.set & b.set)}; }
  friend Mask operator|(Mask a, Mask b) { return {static_cast<__mmask8>(a.set | b.set)}; }
};

struct Value {
  using Scalar = double;

  __m512d x;

  Value() = default;
  explicit Value(double value) : x(_mm512_set1_pd(value)) {}
  explicit Value(__m512d value) : x(value) {}
  static Value load(const double* from) { return Value(_mm512_loadu_pd(from)); }
  /// x, y and z of a point at each of the addresses; a fourth number follows each.
  static std::array<Value, 3> load_points(const double* const* rows) {
    const auto low = AvxPoints<Value>::load(rows), high = AvxPoints<Value>::load(rows + 4);
    return {joined(low.x, high.x), joined(low.y, high.y), joined(low.z, high.z)};
  }
  static Value joined(__m256d low, __m256d high) {
    return Value(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  }
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
  friend Mask operator<=(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_LE_OQ)};
  }
  friend Mask operator>=(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_GE_OQ)};
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return {_mm512_cmp_pd_mask(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend Value min(const Value& a, const Value& b) { return Value(_mm512_min_pd(a.x, b.x)); }
  friend Value max(const Value& a, const Value& b) { return Value(_mm512_max_pd(a.x, b.x)); }
  friend Value abs(const Value& a) { return Value(_mm512_abs_pd(a.x)); }
  friend Value sqrt(const Value& a) { return Value(_mm512_sqrt_pd(a.x)); }
  friend Value select(const Mask& mask, const Value& a, const Value& b) {
    return Value(_mm512_mask_blend_pd(mask.set, b.x, a.x));
  }
  /// a · b − product, with a single rounding.
  friend Value product_error(const Value& a, const Value& b, const Value& product) {
    return Value(_mm512_fmsub_pd(a.x, b.x, product.x));
  }
};

}  // namespace
}  // namespace touchstone::fast

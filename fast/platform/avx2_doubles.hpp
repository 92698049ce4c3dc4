#pragma once

/// \file
/// Four doubles in a register of AVX2 and FMA, and masks of them, for the kernels. They are
/// local to the including file, so that no other file links code for these instructions.

#include <immintrin.h>

#include <array>

#include "fast/platform/avx_rows.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct Mask {
  __m256d set;

  static Mask none() { return {_mm256_setzero_pd()}; }
  static Mask all() { return {_mm256_castsi256_pd(_mm256_set1_epi64x(-1))}; }
  [[nodiscard]] unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_pd(set)); }

  friend Mask operator&(const Mask& a, const Mask& b) { return {_mm256_and_pd(a.set, b.set)}; }
  friend Mask operator|(const Mask& a, const Mask& b) { return {_mm256_or_pd(a.set, b.set)}; }
};

struct Value {
  using Scalar = double;

  __m256d x;

  Value() = default;
  explicit Value(double value) : x(_mm256_set1_pd(value)) {}
  explicit Value(__m256d value) : x(value) {}
  static Value load(const double* from) { return Value(_mm256_loadu_pd(from)); }
  /// x, y and z of a point at each of the addresses; a fourth number follows each.
  static std::array<Value, 3> load_points(const double* const* rows) {
    const auto points = AvxPoints<Value>::load(rows);
    return {Value(points.x), Value(points.y), Value(points.z)};
  }
  void store(double* to) const { _mm256_storeu_pd(to, x); }

  friend Value operator+(const Value& a, const Value& b) { return Value(_mm256_add_pd(a.x, b.x)); }
  friend Value operator-(const Value& a, const Value& b) { return Value(_mm256_sub_pd(a.x, b.x)); }
  friend Value operator*(const Value& a, const Value& b) { return Value(_mm256_mul_pd(a.x, b.x)); }
  friend Value operator/(const Value& a, const Value& b) { return Value(_mm256_div_pd(a.x, b.x)); }
  friend Mask operator<(const Value& a, const Value& b) {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_LT_OQ)};
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_GT_OQ)};
  }
  friend Mask operator<=(const Value& a, const Value& b) {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_LE_OQ)};
  }
  friend Mask operator>=(const Value& a, const Value& b) {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_GE_OQ)};
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return {_mm256_cmp_pd(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend Value min(const Value& a, const Value& b) { return Value(_mm256_min_pd(a.x, b.x)); }
  friend Value max(const Value& a, const Value& b) { return Value(_mm256_max_pd(a.x, b.x)); }
  friend Value abs(const Value& a) { return Value(_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.x)); }
  friend Value sqrt(const Value& a) { return Value(_mm256_sqrt_pd(a.x)); }
  friend Value select(const Mask& mask, const Value& a, const Value& b) {
    return Value(_mm256_blendv_pd(b.x, a.x, mask.set));
  }
  /// a · b − product, with a single rounding.
  friend Value product_error(const Value& a, const Value& b, const Value& product) {
    return Value(_mm256_fmsub_pd(a.x, b.x, product.x));
  }
};

}  // namespace
}  // namespace touchstone::fast

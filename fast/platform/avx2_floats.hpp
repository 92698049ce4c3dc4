#pragma once

/// \file
/// Sixteen floats in two registers of AVX2, masks of them, and sixteen whole numbers, for the
/// kernels. They are local to the including file, so that no other file links code for these
/// instructions.

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct FloatMask {
  __m256 low, high;

  static FloatMask none() { return {_mm256_setzero_ps(), _mm256_setzero_ps()}; }
  static FloatMask all() {
    const __m256 ones = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
    return {ones, ones};
  }
  [[nodiscard]] unsigned bits() const {
    return static_cast<unsigned>(_mm256_movemask_ps(low)) |
           static_cast<unsigned>(_mm256_movemask_ps(high)) << 8U;
  }

  friend FloatMask operator&(const FloatMask& a, const FloatMask& b) {
    return {_mm256_and_ps(a.low, b.low), _mm256_and_ps(a.high, b.high)};
  }
  friend FloatMask operator|(const FloatMask& a, const FloatMask& b) {
    return {_mm256_or_ps(a.low, b.low), _mm256_or_ps(a.high, b.high)};
  }
};

struct Floats {
  using Scalar = float;

  __m256 low, high;

  Floats() = default;
  explicit Floats(float value) : low(_mm256_set1_ps(value)), high(low) {}
  Floats(__m256 first, __m256 second) : low(first), high(second) {}
  static Floats load(const float* from) {
    return {_mm256_loadu_ps(from), _mm256_loadu_ps(from + 8)};
  }
  void store(float* to) const {
    _mm256_storeu_ps(to, low);
    _mm256_storeu_ps(to + 8, high);
  }

  friend Floats operator+(const Floats& a, const Floats& b) {
    return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)};
  }
  friend Floats operator-(const Floats& a, const Floats& b) {
    return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)};
  }
  friend Floats operator*(const Floats& a, const Floats& b) {
    return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)};
  }
  friend Floats operator/(const Floats& a, const Floats& b) {
    return {_mm256_div_ps(a.low, b.low), _mm256_div_ps(a.high, b.high)};
  }
  friend FloatMask operator<(const Floats& a, const Floats& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ)};
  }
  friend FloatMask operator>(const Floats& a, const Floats& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_GT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_GT_OQ)};
  }
  friend FloatMask operator<=(const Floats& a, const Floats& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_LE_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LE_OQ)};
  }
  friend FloatMask operator>=(const Floats& a, const Floats& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_GE_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_GE_OQ)};
  }
  friend FloatMask operator==(const Floats& a, const Floats& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_EQ_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_EQ_OQ)};
  }
  friend Floats min(const Floats& a, const Floats& b) {
    return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)};
  }
  friend Floats max(const Floats& a, const Floats& b) {
    return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)};
  }
  friend Floats select(const FloatMask& mask, const Floats& a, const Floats& b) {
    return {_mm256_blendv_ps(b.low, a.low, mask.low), _mm256_blendv_ps(b.high, a.high, mask.high)};
  }
  friend Floats abs(const Floats& a) {
    const __m256 sign = _mm256_set1_ps(-0.0F);
    return {_mm256_andnot_ps(sign, a.low), _mm256_andnot_ps(sign, a.high)};
  }
};

struct Wholes {
  __m256i low, high;

  /// x, y and z of a member of sixteen items; a fourth number follows each.
  template <class Item>
  static std::array<Wholes, 3> load(const Item* const* items,
                                    std::array<std::int32_t, 4> Item::*member) {
    const auto row = [=](std::size_t i) { return (items[i]->*member).data(); };
    const auto [x0, y0, z0] = load_half(row, 0);
    const auto [x1, y1, z1] = load_half(row, 8);
    return {Wholes{x0, x1}, Wholes{y0, y1}, Wholes{z0, z1}};
  }

  /// The difference, rounded to a float.
  friend Floats operator-(const Wholes& a, const Wholes& b) {
    return {_mm256_cvtepi32_ps(_mm256_sub_epi32(a.low, b.low)),
            _mm256_cvtepi32_ps(_mm256_sub_epi32(a.high, b.high))};
  }

 private:
  struct Half {
    __m256i x, y, z;
  };
  template <class Row>
  static Half load_half(const Row& row, std::size_t first) {
    const auto load = [&](std::size_t i) {
      return _mm_load_si128(reinterpret_cast<const __m128i*>(row(first + i)));
    };
    // Rows i and i + 4.
    const auto two = [&](std::size_t i) {
      return _mm256_inserti128_si256(_mm256_castsi128_si256(load(i)), load(i + 4), 1);
    };
    const __m256i a = two(0), b = two(1), c = two(2), d = two(3);
    const __m256i xy_ab = _mm256_unpacklo_epi32(a, b), xy_cd = _mm256_unpacklo_epi32(c, d);
    const __m256i z_ab = _mm256_unpackhi_epi32(a, b), z_cd = _mm256_unpackhi_epi32(c, d);
    return {_mm256_unpacklo_epi64(xy_ab, xy_cd), _mm256_unpackhi_epi64(xy_ab, xy_cd),
            _mm256_unpacklo_epi64(z_ab, z_cd)};
  }
};

}  // namespace
}  // namespace touchstone::fast

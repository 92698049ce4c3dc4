#pragma once

/// \file
/// Sixteen floats in a register of AVX-512's foundation, masks of them, and sixteen whole numbers,
/// for the kernels. They are local to the including file, so that no other file links code for
/// these instructions.

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct FloatMask {
  __mmask16 set;

  static FloatMask none() { return {0}; }
  static FloatMask all() { return {0xFFFF}; }
  [[nodiscard]] unsigned bits() const { return set; }

  friend FloatMask operator&(FloatMask a, FloatMask b) {
    return {static_cast<__mmask16>(a.set & b.set)};
  }
  friend FloatMask operator|(FloatMask a, FloatMask b) {
    return {static_cast<__mmask16>(a.set | b.set)};
  }
};

struct Floats {
  using Scalar = float;
  static constexpr std::size_t width = 16;

  __m512 x;

  Floats() = default;
  explicit Floats(float value) : x(_mm512_set1_ps(value)) {}
  explicit Floats(__m512 value) : x(value) {}
  static Floats load(const float* from) { return Floats(_mm512_loadu_ps(from)); }
  void store(float* to) const { _mm512_storeu_ps(to, x); }

  friend Floats operator+(const Floats& a, const Floats& b) {
    return Floats(_mm512_add_ps(a.x, b.x));
  }
  friend Floats operator-(const Floats& a, const Floats& b) {
    return Floats(_mm512_sub_ps(a.x, b.x));
  }
  friend Floats operator*(const Floats& a, const Floats& b) {
    return Floats(_mm512_mul_ps(a.x, b.x));
  }
  friend Floats operator/(const Floats& a, const Floats& b) {
    return Floats(_mm512_div_ps(a.x, b.x));
  }
  friend FloatMask operator<(const Floats& a, const Floats& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_LT_OQ)};
  }
  friend FloatMask operator>(const Floats& a, const Floats& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_GT_OQ)};
  }
  friend FloatMask operator<=(const Floats& a, const Floats& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_LE_OQ)};
  }
  friend FloatMask operator>=(const Floats& a, const Floats& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_GE_OQ)};
  }
  friend FloatMask operator==(const Floats& a, const Floats& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend Floats min(const Floats& a, const Floats& b) { return Floats(_mm512_min_ps(a.x, b.x)); }
  friend Floats max(const Floats& a, const Floats& b) { return Floats(_mm512_max_ps(a.x, b.x)); }
  friend Floats abs(const Floats& a) { return Floats(_mm512_abs_ps(a.x)); }
  friend Floats select(const FloatMask& mask, const Floats& a, const Floats& b) {
    return Floats(_mm512_mask_blend_ps(mask.set, b.x, a.x));
  }
};

struct Wholes {
  __m512i x;

  /// x, y and z of a member of sixteen items; a fourth number follows each.
  template <class Item>
  static std::array<Wholes, 3> load(const Item* const* items,
                                    std::array<std::int32_t, 4> Item::*member) {
    const auto row = [=](std::size_t i) { return (items[i]->*member).data(); };
    const __m512i a = part(row, 0), b = part(row, 1), c = part(row, 2), d = part(row, 3);
    const __m512i xy_ab = _mm512_unpacklo_epi32(a, b), xy_cd = _mm512_unpacklo_epi32(c, d);
    const __m512i z_ab = _mm512_unpackhi_epi32(a, b), z_cd = _mm512_unpackhi_epi32(c, d);
    return {Wholes{_mm512_unpacklo_epi64(xy_ab, xy_cd)},
            Wholes{_mm512_unpackhi_epi64(xy_ab, xy_cd)}, Wholes{_mm512_unpacklo_epi64(z_ab, z_cd)}};
  }

  /// The difference, rounded to a float.
  friend Floats operator-(const Wholes& a, const Wholes& b) {
    return Floats(_mm512_cvtepi32_ps(_mm512_sub_epi32(a.x, b.x)));
  }

 private:
  /// Every fourth row from `first` on.
  template <class Row>
  static __m512i part(const Row& row, std::size_t first) {
    const auto load = [&](std::size_t i) {
      return _mm_load_si128(reinterpret_cast<const __m128i*>(row(first + i)));
    };
    __m512i result = _mm512_castsi128_si512(load(0));
    result = _mm512_inserti32x4(result, load(4), 1);
    result = _mm512_inserti32x4(result, load(8), 2);
    return _mm512_inserti32x4(result, load(12), 3);
  }
};

}  // namespace
}  // namespace touchstone::fast

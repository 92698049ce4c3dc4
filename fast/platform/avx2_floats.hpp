#pragma once

/// \file
/// Eight floats in a register of AVX2, masks of them, and eight whole numbers, for the kernels; and
/// sixteen floats that are only compared. They are local to the including file, so that no other
/// file links code for these instructions.

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct EightMask {
  __m256 set;

  static EightMask none() { return {_mm256_setzero_ps()}; }
  static EightMask all() { return {_mm256_castsi256_ps(_mm256_set1_epi32(-1))}; }
  [[nodiscard]] unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_ps(set)); }

  friend EightMask operator&(EightMask a, EightMask b) { return {_mm256_and_ps(a.set, b.set)}; }
  friend EightMask operator|(EightMask a, EightMask b) { return {_mm256_or_ps(a.set, b.set)}; }
};

struct EightFloats {
  using Scalar = float;
  static constexpr std::size_t width = 8;

  __m256 x;

  EightFloats() = default;
  explicit EightFloats(float value) : x(_mm256_set1_ps(value)) {}
  explicit EightFloats(__m256 value) : x(value) {}

  friend EightFloats operator+(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_add_ps(a.x, b.x));
  }
  friend EightFloats operator-(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_sub_ps(a.x, b.x));
  }
  friend EightFloats operator*(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_mul_ps(a.x, b.x));
  }
  friend EightFloats operator/(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_div_ps(a.x, b.x));
  }
  friend EightMask operator<(const EightFloats& a, const EightFloats& b) {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_LT_OQ)};
  }
  friend EightMask operator>(const EightFloats& a, const EightFloats& b) {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_GT_OQ)};
  }
  friend EightMask operator<=(const EightFloats& a, const EightFloats& b) {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_LE_OQ)};
  }
  friend EightMask operator>=(const EightFloats& a, const EightFloats& b) {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_GE_OQ)};
  }
  friend EightMask operator==(const EightFloats& a, const EightFloats& b) {
    return {_mm256_cmp_ps(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend EightFloats min(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_min_ps(a.x, b.x));
  }
  friend EightFloats max(const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_max_ps(a.x, b.x));
  }
  friend EightFloats abs(const EightFloats& a) {
    return EightFloats(_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.x));
  }
  friend EightFloats select(const EightMask& mask, const EightFloats& a, const EightFloats& b) {
    return EightFloats(_mm256_blendv_ps(b.x, a.x, mask.set));
  }
};

struct EightWholes {
  __m256i x;

  /// x, y and z of a member of eight items; a fourth number follows each.
  template <class Item>
  static std::array<EightWholes, 3> load(const Item* const* items,
                                         std::array<std::int32_t, 4> Item::*member) {
    // Rows i and i + 4.
    const auto two = [=](std::size_t i) {
      const auto row = [=](std::size_t k) {
        return _mm_load_si128(reinterpret_cast<const __m128i*>((items[k]->*member).data()));
      };
      return _mm256_inserti128_si256(_mm256_castsi128_si256(row(i)), row(i + 4), 1);
    };
    const __m256i a = two(0), b = two(1), c = two(2), d = two(3);
    const __m256i xy_ab = _mm256_unpacklo_epi32(a, b), xy_cd = _mm256_unpacklo_epi32(c, d);
    const __m256i z_ab = _mm256_unpackhi_epi32(a, b), z_cd = _mm256_unpackhi_epi32(c, d);
    return {EightWholes{_mm256_unpacklo_epi64(xy_ab, xy_cd)},
            EightWholes{_mm256_unpackhi_epi64(xy_ab, xy_cd)},
            EightWholes{_mm256_unpacklo_epi64(z_ab, z_cd)}};
  }

  /// The difference, rounded to a float.
  friend EightFloats operator-(const EightWholes& a, const EightWholes& b) {
    return EightFloats(_mm256_cvtepi32_ps(_mm256_sub_epi32(a.x, b.x)));
  }
};

struct SixteenMask {
  EightMask low, high;

  static SixteenMask none() { return {EightMask::none(), EightMask::none()}; }
  [[nodiscard]] unsigned bits() const { return low.bits() | high.bits() << 8U; }

  friend SixteenMask operator&(const SixteenMask& a, const SixteenMask& b) {
    return {a.low & b.low, a.high & b.high};
  }
  friend SixteenMask operator|(const SixteenMask& a, const SixteenMask& b) {
    return {a.low | b.low, a.high | b.high};
  }
};

struct SixteenFloats {
  EightFloats low, high;

  SixteenFloats() = default;
  explicit SixteenFloats(float value) : low(value), high(low) {}
  SixteenFloats(const EightFloats& first, const EightFloats& second) : low(first), high(second) {}
  static SixteenFloats load(const float* from) {
    return {EightFloats(_mm256_loadu_ps(from)), EightFloats(_mm256_loadu_ps(from + 8))};
  }
  void store(float* to) const {
    _mm256_storeu_ps(to, low.x);
    _mm256_storeu_ps(to + 8, high.x);
  }

  friend SixteenMask operator>(const SixteenFloats& a, const SixteenFloats& b) {
    return {a.low > b.low, a.high > b.high};
  }
  friend SixteenMask operator==(const SixteenFloats& a, const SixteenFloats& b) {
    return {a.low == b.low, a.high == b.high};
  }
  friend SixteenFloats min(const SixteenFloats& a, const SixteenFloats& b) {
    return {min(a.low, b.low), min(a.high, b.high)};
  }
  friend SixteenFloats max(const SixteenFloats& a, const SixteenFloats& b) {
    return {max(a.low, b.low), max(a.high, b.high)};
  }
};

}  // namespace
}  // namespace touchstone::fast

#pragma once

/// \file
/// Lanes in registers of AVX-512's foundation and FMA: eight doubles, sixteen floats, sixteen whole
/// numbers.

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "fast/platform/lanes.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of lanes.hpp

struct Avx512 : Portable {
  template <class Number, std::size_t count>
  using Truth = std::conditional_t<count == 8, __mmask8, __mmask16>;
  static constexpr bool is_fused = true;

  static __mmask8 less(__m512d a, __m512d b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static __mmask16 less(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static __mmask8 less_equal(__m512d a, __m512d b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  static __mmask16 less_equal(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
  static __mmask8 equal(__m512d a, __m512d b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
  static __mmask16 equal(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
  using Words = RegisterOf<std::int32_t, 16>;
  static __mmask16 equal(const Words& a, const Words& b) {
    return _mm512_cmpeq_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b));
  }
  static __m512d select(__mmask8 truth, __m512d a, __m512d b) {
    return _mm512_mask_blend_pd(truth, b, a);
  }
  static __m512 select(__mmask16 truth, __m512 a, __m512 b) {
    return _mm512_mask_blend_ps(truth, b, a);
  }
  // As of Avx2.
  static __m512d min(__m512d a, __m512d b) { return _mm512_min_pd(a, b); }
  static __m512 min(__m512 a, __m512 b) { return _mm512_min_ps(a, b); }
  static __m512d max(__m512d a, __m512d b) { return _mm512_max_pd(a, b); }
  static __m512 max(__m512 a, __m512 b) { return _mm512_max_ps(a, b); }
  static __m512d sqrt(__m512d a) { return _mm512_sqrt_pd(a); }
  static __m512d product_error(__m512d a, __m512d b, __m512d product) {
    return _mm512_fmsub_pd(a, b, product);
  }

  template <std::size_t count, class Row>
  static Columns<Words> columns(const Row& row) {
    const auto load = [&](std::size_t i) {
      return _mm_load_si128(reinterpret_cast<const __m128i*>(row(i)));
    };
    // Every fourth row.
    const auto four = [&](std::size_t i) {
      __m512i result = _mm512_castsi128_si512(load(i));
      result = _mm512_inserti32x4(result, load(i + 4), 1);
      result = _mm512_inserti32x4(result, load(i + 8), 2);
      return _mm512_inserti32x4(result, load(i + 12), 3);
    };
    const __m512i a = four(0), b = four(1), c = four(2), d = four(3);
    const __m512i xy_ab = _mm512_unpacklo_epi32(a, b), xy_cd = _mm512_unpacklo_epi32(c, d);
    const __m512i z_ab = _mm512_unpackhi_epi32(a, b), z_cd = _mm512_unpackhi_epi32(c, d);
    return {reinterpret_cast<Words>(_mm512_unpacklo_epi64(xy_ab, xy_cd)),
            reinterpret_cast<Words>(_mm512_unpackhi_epi64(xy_ab, xy_cd)),
            reinterpret_cast<Words>(_mm512_unpacklo_epi64(z_ab, z_cd))};
  }
};

struct Avx512Lanes {
  using Value = ValueOn<Avx512, double, 8>;
  using Mask = Value::Mask;
  using Row = Avx2Lanes::Row;
  using Single = ValueOn<Avx512, float, 16>;
  using Rounded = WholesOn<Avx512, 16>;
  using Sixteen = Single;
  static constexpr std::size_t width = 8;

  [[gnu::always_inline]] static std::array<Value, 3> load(
      const std::array<const double*, 8>& rows) {
    return joined(Avx2Lanes::load(half(rows, 0)), Avx2Lanes::load(half(rows, 4)));
  }
  [[gnu::always_inline]] static std::array<Value, 3> load_backwards(
      const std::array<const double*, 8>& rows) {
    return joined(Avx2Lanes::load_backwards(half(rows, 0)),
                  Avx2Lanes::load_backwards(half(rows, 4)));
  }
  static Row load_row_backwards(const double* from) { return Avx2Lanes::load_row_backwards(from); }

 private:
  static std::array<const double*, 4> half(const std::array<const double*, 8>& rows,
                                           std::size_t first) {
    return {rows[first], rows[first + 1], rows[first + 2], rows[first + 3]};
  }
  using Four = std::array<Avx2Lanes::Value, 3>;
  [[gnu::always_inline]] static std::array<Value, 3> joined(const Four& low, const Four& high) {
    const auto axis = [&](std::size_t i) {
      return Value(_mm512_insertf64x4(_mm512_castpd256_pd512(low[i].x), high[i].x, 1));
    };
    return {axis(0), axis(1), axis(2)};
  }
};

}  // namespace
}  // namespace touchstone::fast

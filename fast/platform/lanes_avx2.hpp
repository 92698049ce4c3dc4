#pragma once

/// \file
/// Lanes in registers of AVX2 and FMA: four doubles, eight floats, eight whole numbers.

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "fast/platform/lanes.hpp"

namespace touchstone::fast {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): as of lanes.hpp

struct Avx2 : Portable {
  template <class Number, std::size_t count>
  using Truth = RegisterOf<Number, count>;
  static constexpr bool is_fused = true;

  static __m256d both(__m256d a, __m256d b) { return _mm256_and_pd(a, b); }
  static __m256 both(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }
  static __m256d either(__m256d a, __m256d b) { return _mm256_or_pd(a, b); }
  static __m256 either(__m256 a, __m256 b) { return _mm256_or_ps(a, b); }
  static unsigned bits(__m256d truth) { return static_cast<unsigned>(_mm256_movemask_pd(truth)); }
  static unsigned bits(__m256 truth) { return static_cast<unsigned>(_mm256_movemask_ps(truth)); }
  static __m256d select(__m256d truth, __m256d a, __m256d b) {
    return _mm256_blendv_pd(b, a, truth);
  }
  static __m256 select(__m256 truth, __m256 a, __m256 b) { return _mm256_blendv_ps(b, a, truth); }
  // GCC 12 makes of comparisons and selections the instruction for some alone.
  static __m256d min(__m256d a, __m256d b) { return _mm256_min_pd(a, b); }
  static __m256 min(__m256 a, __m256 b) { return _mm256_min_ps(a, b); }
  static __m256d max(__m256d a, __m256d b) { return _mm256_max_pd(a, b); }
  static __m256 max(__m256 a, __m256 b) { return _mm256_max_ps(a, b); }
  static __m256d sqrt(__m256d a) { return _mm256_sqrt_pd(a); }
  static __m256d product_error(__m256d a, __m256d b, __m256d product) {
    return _mm256_fmsub_pd(a, b, product);
  }

  template <std::size_t count, class Row>
  static Columns<RegisterOf<std::int32_t, 8>> columns(const Row& row) {
    const auto load = [&](std::size_t i) {
      return _mm_load_si128(reinterpret_cast<const __m128i*>(row(i)));
    };
    // Rows i and i + 4.
    const auto two = [&](std::size_t i) {
      return _mm256_inserti128_si256(_mm256_castsi128_si256(load(i)), load(i + 4), 1);
    };
    const __m256i a = two(0), b = two(1), c = two(2), d = two(3);
    const __m256i xy_ab = _mm256_unpacklo_epi32(a, b), xy_cd = _mm256_unpacklo_epi32(c, d);
    const __m256i z_ab = _mm256_unpackhi_epi32(a, b), z_cd = _mm256_unpackhi_epi32(c, d);
    using Words = RegisterOf<std::int32_t, 8>;
    return {reinterpret_cast<Words>(_mm256_unpacklo_epi64(xy_ab, xy_cd)),
            reinterpret_cast<Words>(_mm256_unpackhi_epi64(xy_ab, xy_cd)),
            reinterpret_cast<Words>(_mm256_unpacklo_epi64(z_ab, z_cd))};
  }
};

struct Avx2Lanes {
  using Value = ValueOn<Avx2, double, 4>;
  using Mask = Value::Mask;
  /// x, y, z and an undefined fourth number.
  using Row = Value;
  using Single = ValueOn<Avx2, float, 8>;
  using Rounded = WholesOn<Avx2, 8>;
  using Sixteen = Joined<Single>;
  static constexpr std::size_t width = 4;

  [[gnu::always_inline]] static std::array<Value, 3> load(
      const std::array<const double*, 4>& rows) {
    const auto [first, second, third, fourth] = transposed(rows, 0);
    return {first, second, third};
  }
  [[gnu::always_inline]] static std::array<Value, 3> load_backwards(
      const std::array<const double*, 4>& rows) {
    const auto [first, second, third, fourth] = transposed(rows, 1);
    return {second, third, fourth};
  }
  static Row load_row_backwards(const double* from) {
    return Row(_mm256_permute4x64_pd(_mm256_loadu_pd(from - 1), 0b00'11'10'01));
  }

 private:
  /// The transpose of the four numbers at each address less `before`.
  [[gnu::always_inline]] static std::array<Value, 4> transposed(
      const std::array<const double*, 4>& rows, std::size_t before) {
    const auto row = [&](std::size_t i) { return _mm256_loadu_pd(rows[i] - before); };
    const __m256d a = row(0), b = row(1), c = row(2), d = row(3);
    const __m256d even_low = _mm256_unpacklo_pd(a, b), odd_low = _mm256_unpackhi_pd(a, b);
    const __m256d even_high = _mm256_unpacklo_pd(c, d), odd_high = _mm256_unpackhi_pd(c, d);
    return {Value(_mm256_permute2f128_pd(even_low, even_high, 0x20)),
            Value(_mm256_permute2f128_pd(odd_low, odd_high, 0x20)),
            Value(_mm256_permute2f128_pd(even_low, even_high, 0x31)),
            Value(_mm256_permute2f128_pd(odd_low, odd_high, 0x31))};
  }
};

}  // namespace
}  // namespace touchstone::fast

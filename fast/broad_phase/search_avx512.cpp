// The search in AVX-512 (its foundation, F): sixteen boxes per vector; compiled for AVX-512, and
// called only on processors with it.

#include <immintrin.h>

#include "fast/broad_phase/search_on_lanes.hpp"

namespace touchstone::fast {
namespace {

struct Mask {
  __mmask16 set;

  static Mask none() { return {0}; }
  static Mask all() { return {0xFFFF}; }
  [[nodiscard]] unsigned bits() const { return set; }

  friend Mask operator&(Mask a, Mask b) { return {static_cast<__mmask16>(a.set & b.set)}; }
  friend Mask operator|(Mask a, Mask b) { return {static_cast<__mmask16>(a.set | b.set)}; }
};

struct Value {
  using Scalar = float;

  __m512 x;

  Value() = default;
  explicit Value(float value) : x(_mm512_set1_ps(value)) {}
  explicit Value(__m512 value) : x(value) {}
  static Value load(const float* from) { return Value(_mm512_loadu_ps(from)); }
  void store(float* to) const { _mm512_storeu_ps(to, x); }

  friend Value operator+(const Value& a, const Value& b) { return Value(_mm512_add_ps(a.x, b.x)); }
  friend Value operator-(const Value& a, const Value& b) { return Value(_mm512_sub_ps(a.x, b.x)); }
  friend Value operator*(const Value& a, const Value& b) { return Value(_mm512_mul_ps(a.x, b.x)); }
  friend Mask operator<(const Value& a, const Value& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_LT_OQ)};
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_GT_OQ)};
  }
  friend Mask operator<=(const Value& a, const Value& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_LE_OQ)};
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return {_mm512_cmp_ps_mask(a.x, b.x, _CMP_EQ_OQ)};
  }
  friend Value min(const Value& a, const Value& b) { return Value(_mm512_min_ps(a.x, b.x)); }
  friend Value max(const Value& a, const Value& b) { return Value(_mm512_max_ps(a.x, b.x)); }
  friend Value abs(const Value& a) { return Value(_mm512_abs_ps(a.x)); }
};

struct Lanes {
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;

  static Value pick(const float* from, __m512i indices) {
    return Value(_mm512_permutexvar_ps(indices, _mm512_load_ps(from)));
  }
  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    return _mm512_cmpeq_epi32_mask(_mm512_load_si512(values), _mm512_set1_epi32(value));
  }

  static __m512i load_words(const void* from) { return _mm512_load_si512(from); }
  static void write(void* to, __m512i words, unsigned bits) {
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), words));
  }

  template <bool is_ordered>
  static IndexPair* append(IndexPair* to, std::int32_t number, const std::int32_t* numbers,
                           unsigned bits) {
    __m512i first = _mm512_set1_epi32(number), second = _mm512_load_si512(numbers);
    if constexpr (is_ordered) {
      const __m512i less = _mm512_min_epi32(first, second);
      second = _mm512_max_epi32(first, second);
      first = less;
    }
    to = append_half(to, _mm512_castsi512_si256(first), _mm512_castsi512_si256(second),
                     bits & 0xFFU);
    return append_half(to, _mm512_extracti64x4_epi64(first, 1),
                       _mm512_extracti64x4_epi64(second, 1), bits >> 8U);
  }

 private:
  static IndexPair* append_half(IndexPair* to, __m256i first, __m256i second, unsigned bits) {
    const __m512i pairs = _mm512_or_si512(_mm512_cvtepu32_epi64(first),
                                          _mm512_slli_epi64(_mm512_cvtepu32_epi64(second), 32));
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi64(static_cast<__mmask8>(bits), pairs));
    return to + __builtin_popcount(bits);
  }
};

}  // namespace

extern const SearchKernel avx512_search_kernel;
const SearchKernel avx512_search_kernel = search_kernel_on<Lanes>(InstructionSet::avx512);

}  // namespace touchstone::fast

// The search in AVX-512 (its foundation, F): sixteen boxes per vector; compiled for AVX-512, and
// called only on processors with it.

#include <immintrin.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/platform/lanes_avx512.hpp"

namespace touchstone::fast {
namespace {

struct Lanes {
  using Value = Avx512Lanes::Sixteen;
  using Mask = Value::Mask;

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

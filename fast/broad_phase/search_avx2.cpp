// The search in AVX2: sixteen boxes in two vectors; compiled for AVX2, and called only on
// processors with AVX2.

#include <immintrin.h>

#include "fast/broad_phase/search_on_lanes.hpp"
#include "fast/platform/lanes_avx2.hpp"

namespace touchstone::fast {
namespace {

/// The lanes' numbers in sequence, one byte each, for each set of eight lanes.
constexpr std::array<std::uint64_t, 256> make_places() {
  std::array<std::uint64_t, 256> result{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    unsigned shift = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if ((bits >> lane & 1U) == 0) continue;
      result[bits] |= std::uint64_t{lane} << shift;
      shift += 8;
    }
  }
  return result;
}
constexpr std::array<std::uint64_t, 256> places = make_places();

struct Lanes {
  using Value = Avx2Lanes::Sixteen;
  using Mask = Value::Mask;

  struct Words {
    __m256i low, high;
  };
  template <class Word>
  static Words load_words(const Word* from) {
    return {load_whole(from), load_whole(from + 8)};
  }
  template <class Word>
  static void write(Word* to, const Words& words, unsigned bits) {
    const unsigned low = bits & 0xFFU;
    store_whole(to, _mm256_permutevar8x32_epi32(words.low, order_of(low)));
    store_whole(to + __builtin_popcount(low),
                _mm256_permutevar8x32_epi32(words.high, order_of(bits >> 8U)));
  }

  template <bool is_ordered>
  static IndexPair* append(IndexPair* to, std::int32_t number, const std::int32_t* numbers,
                           unsigned bits) {
    to = append_half<is_ordered>(to, number, numbers, bits & 0xFFU);
    return append_half<is_ordered>(to, number, numbers + 8, bits >> 8U);
  }

 private:
  static __m256i load_whole(const void* from) {
    return _mm256_load_si256(static_cast<const __m256i*>(from));
  }
  static void store_whole(void* to, __m256i words) {
    _mm256_storeu_si256(static_cast<__m256i*>(to), words);
  }

  /// The permutation that brings the lanes selected by the bits to the front.
  static __m256i order_of(unsigned bits) {
    return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(places[bits])));
  }

  template <bool is_ordered>
  static IndexPair* append_half(IndexPair* to, std::int32_t number, const std::int32_t* numbers,
                                unsigned bits) {
    __m256i first = _mm256_set1_epi32(number);
    __m256i second = _mm256_permutevar8x32_epi32(load_whole(numbers), order_of(bits));
    if constexpr (is_ordered) {
      const __m256i less = _mm256_min_epi32(first, second);
      second = _mm256_max_epi32(first, second);
      first = less;
    }
    // Pairs 0, 1, 4, 5 and 2, 3, 6, 7.
    const __m256i even = _mm256_unpacklo_epi32(first, second);
    const __m256i odd = _mm256_unpackhi_epi32(first, second);
    auto* const place = reinterpret_cast<__m256i*>(to);
    _mm256_storeu_si256(place, _mm256_permute2x128_si256(even, odd, 0x20));
    _mm256_storeu_si256(place + 1, _mm256_permute2x128_si256(even, odd, 0x31));
    return to + __builtin_popcount(bits);
  }
};

}  // namespace

extern const SearchKernel avx2_search_kernel;
const SearchKernel avx2_search_kernel = search_kernel_on<Lanes>(InstructionSet::avx2);

}  // namespace touchstone::fast

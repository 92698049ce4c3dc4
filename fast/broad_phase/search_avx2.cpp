// The search in AVX2: sixteen boxes in two vectors; compiled for AVX2, and called only on
// processors with AVX2.

#include <immintrin.h>

#include <utility>

#include "fast/broad_phase/search_on_lanes.hpp"

namespace touchstone::fast {
namespace {

struct Mask {
  __m256 low, high;

  static Mask none() { return {_mm256_setzero_ps(), _mm256_setzero_ps()}; }
  static Mask all() {
    const __m256 ones = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
    return {ones, ones};
  }
  [[nodiscard]] unsigned bits() const {
    return static_cast<unsigned>(_mm256_movemask_ps(low)) |
           static_cast<unsigned>(_mm256_movemask_ps(high)) << 8U;
  }

  friend Mask operator&(const Mask& a, const Mask& b) {
    return {_mm256_and_ps(a.low, b.low), _mm256_and_ps(a.high, b.high)};
  }
  friend Mask operator|(const Mask& a, const Mask& b) {
    return {_mm256_or_ps(a.low, b.low), _mm256_or_ps(a.high, b.high)};
  }
};

struct Value {
  using Scalar = float;

  __m256 low, high;

  Value() = default;
  explicit Value(float value) : low(_mm256_set1_ps(value)), high(low) {}
  Value(__m256 first, __m256 second) : low(first), high(second) {}
  static Value load(const float* from) {
    return {_mm256_loadu_ps(from), _mm256_loadu_ps(from + 8)};
  }
  void store(float* to) const {
    _mm256_storeu_ps(to, low);
    _mm256_storeu_ps(to + 8, high);
  }

  friend Value operator+(const Value& a, const Value& b) {
    return {_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)};
  }
  friend Value operator-(const Value& a, const Value& b) {
    return {_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)};
  }
  friend Value operator*(const Value& a, const Value& b) {
    return {_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)};
  }
  friend Mask operator<(const Value& a, const Value& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ)};
  }
  friend Mask operator>(const Value& a, const Value& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_GT_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_GT_OQ)};
  }
  friend Mask operator<=(const Value& a, const Value& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_LE_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_LE_OQ)};
  }
  friend Mask operator==(const Value& a, const Value& b) {
    return {_mm256_cmp_ps(a.low, b.low, _CMP_EQ_OQ), _mm256_cmp_ps(a.high, b.high, _CMP_EQ_OQ)};
  }
  friend Value min(const Value& a, const Value& b) {
    return {_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)};
  }
  friend Value max(const Value& a, const Value& b) {
    return {_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)};
  }
  friend Value abs(const Value& a) {
    const __m256 sign = _mm256_set1_ps(-0.0F);
    return {_mm256_andnot_ps(sign, a.low), _mm256_andnot_ps(sign, a.high)};
  }
};

/// For each set of eight lanes, the lanes' numbers in sequence, one byte each.
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
  using Value = touchstone::fast::Value;
  using Mask = touchstone::fast::Mask;

  static unsigned equal_bits(const std::int32_t* values, std::int32_t value) {
    const __m256i all = _mm256_set1_epi32(value);
    const auto equal = [all](const std::int32_t* from) {
      return _mm256_castsi256_ps(_mm256_cmpeq_epi32(load_whole(from), all));
    };
    return Mask{equal(values), equal(values + 8)}.bits();
  }

  struct Words {
    __m256i low, high;
  };
  template <class Word>
  static Words load_words(const Word* from) {
    return {load_whole(from), load_whole(from + 8)};
  }
  static Value pick(const float* from, const Words& indices) {
    return {pick_half(from, indices.low), pick_half(from, indices.high)};
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
  static __m256 pick_half(const float* from, __m256i indices) {
    // Bit 3 of an index, which selects the half, becomes the sign.
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(_mm256_load_ps(from), indices),
                            _mm256_permutevar8x32_ps(_mm256_load_ps(from + 8), indices),
                            _mm256_castsi256_ps(_mm256_slli_epi32(indices, 28)));
  }

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

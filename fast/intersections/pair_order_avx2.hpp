#pragma once

/// \file
/// The order of the vertices of two elements (pair_order.hpp) in a vector of AVX2, for the AVX2 and
/// the AVX-512 kernel. It is local to the including file, so that no other file links code for
/// these instructions.

#include <immintrin.h>

#include "fast/intersections/pair_order.hpp"

namespace touchstone::fast::pair_order {
namespace {  // NOLINT(cert-dcl59-cpp,google-build-namespaces): see above

struct InOneVector {
  using Both = __m256i;

  static Both both(const ElementRow& a, const ElementRow& b) {
    return _mm256_inserti128_si256(_mm256_castsi128_si256(vertices_of(a)), vertices_of(b), 1);
  }

  static unsigned equal_vertices(const Both& both) {
    const __m256i first = _mm256_setr_epi32(0, 1, 2, 0, 1, 2, 0, 1);
    const __m256i second = _mm256_setr_epi32(4, 4, 4, 5, 5, 5, 6, 6);
    const __m256i equal = _mm256_cmpeq_epi32(_mm256_permutevar8x32_epi32(both, first),
                                             _mm256_permutevar8x32_epi32(both, second));
    const auto bits = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(equal)));
    const __m128i a = _mm256_castsi256_si128(both), b = _mm256_extracti128_si256(both, 1);
    const bool are_thirds_equal = _mm_extract_epi32(a, 2) == _mm_extract_epi32(b, 2);
    return bits | static_cast<unsigned>(are_thirds_equal) << 8U;
  }

  static void write(ElementPair* to, const Both& both, const Order& order, const IndexPair& pair) {
    const __m128i places = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&order));
    const __m256i vertices = _mm256_permutevar8x32_epi32(both, _mm256_cvtepu8_epi32(places));
    const __m256i numbers =
        _mm256_broadcastq_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(pair.data())));
    _mm256_store_si256(reinterpret_cast<__m256i*>(to),
                       _mm256_blend_epi32(vertices, numbers, 0b1100'0000));
  }

 private:
  static __m128i vertices_of(const ElementRow& row) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(row.data()));
  }
};

}  // namespace
}  // namespace touchstone::fast::pair_order

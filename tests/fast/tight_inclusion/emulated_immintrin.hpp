#pragma once

/// \file
/// AVX-512 in portable C++ (SIMDe), standing in for <immintrin.h>: so the AVX-512 kernel is tested
/// on processors without it too, from its own source.

#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/avx2.h>
#include <simde/x86/avx512.h>

/// What this version of SIMDe lacks, from Intel's description: lanes move within halves.
template <int order>
simde__m512d permutex_pd(simde__m512d x) {
  const simde__m256d low = simde_mm512_castpd512_pd256(x), high = simde_mm512_extractf64x4_pd(x, 1);
  return simde_mm512_insertf64x4(
      simde_mm512_castpd256_pd512(simde_mm256_permute4x64_pd(low, order)),
      simde_mm256_permute4x64_pd(high, order), 1);
}
#define _mm512_permutex_pd(x, order) permutex_pd<(order)>(x)

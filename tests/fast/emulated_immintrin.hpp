#pragma once

/// \file
/// AVX-512 in portable C++ (SIMDe) in place of <immintrin.h>: the AVX-512 kernels are tested on any
/// processor, from their own sources.

#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/avx2.h>
#include <simde/x86/avx512.h>
#include <simde/x86/fma.h>

#include <cmath>

using __mmask8 = simde__mmask8;
using __mmask16 = simde__mmask16;

/// An intrinsic that this version of SIMDe lacks, by Intel's description.
inline simde__m512i widened_to_64(simde__m256i x) {
  const simde__m256i_private from = simde__m256i_to_private(x);
  simde__m512i_private result;
  for (std::size_t i = 0; i < 8; ++i) result.u64[i] = from.u32[i];
  return simde__m512i_from_private(result);
}
#undef _mm512_cvtepu32_epi64
#define _mm512_cvtepu32_epi64(x) widened_to_64(x)

/// Fused arithmetic: SIMDe rounds the product if the processor cannot fuse.
inline simde__m512d fused_multiply_subtract(simde__m512d a, simde__m512d b, simde__m512d c) {
  const simde__m512d_private x = simde__m512d_to_private(a), y = simde__m512d_to_private(b);
  const simde__m512d_private z = simde__m512d_to_private(c);
  simde__m512d_private result;
  for (std::size_t i = 0; i < 8; ++i) result.f64[i] = std::fma(x.f64[i], y.f64[i], -z.f64[i]);
  return simde__m512d_from_private(result);
}
#undef _mm512_fmsub_pd
#define _mm512_fmsub_pd(a, b, c) fused_multiply_subtract(a, b, c)

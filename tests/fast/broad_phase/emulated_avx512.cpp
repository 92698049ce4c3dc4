// The AVX-512 search from its own source, with emulated intrinsics and under another name.

#include "tests/fast/emulated_immintrin.hpp"

// The search's file includes <immintrin.h>, which here is the header above (see CMakeLists.txt).
#define avx512_search_kernel emulated_avx512_search_kernel
#include "fast/broad_phase/search_avx512.cpp"

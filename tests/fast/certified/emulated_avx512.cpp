// The AVX-512 kernel from its own source, with emulated intrinsics and under another name.

#include "tests/fast/emulated_immintrin.hpp"

// The kernel's file includes <immintrin.h>, which here is the header above (see CMakeLists.txt).
#define avx512_certified_kernel emulated_avx512_certified_kernel
#include "fast/certified/kernel_avx512.cpp"

// The AVX-512 kernel from its own source, with its intrinsics emulated and under another name.

#include "tests/fast/emulated_immintrin.hpp"

// The kernel's file includes <immintrin.h>, which here is the header above (see CMakeLists.txt).
#define avx512_box_kernel emulated_avx512_box_kernel
#include "fast/tight_inclusion/box_kernel_avx512.cpp"

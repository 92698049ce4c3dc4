#include "fast/intersections/filter_kernel.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (filter_*.cpp).
extern const TriangleKernel scalar_triangle_kernel;
#ifdef TOUCHSTONE_X86_64
extern const TriangleKernel avx2_triangle_kernel;
extern const TriangleKernel avx512_triangle_kernel;
#endif
#ifdef TOUCHSTONE_NEON
extern const TriangleKernel neon_triangle_kernel;
#endif

std::span<const TriangleKernel* const> triangle_kernels() {
  static const auto kernels = runnable_kernels<TriangleKernel>(
      {
          &scalar_triangle_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_triangle_kernel,
          &avx512_triangle_kernel,
#endif
#ifdef TOUCHSTONE_NEON
          &neon_triangle_kernel,
#endif
      },
      "triangle kernel", rounds_its_products<TriangleKernel>);
  return kernels;
}

}  // namespace touchstone::fast

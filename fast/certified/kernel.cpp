#include "fast/certified/kernel.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (kernel_*.cpp).
extern const CertifiedKernel scalar_certified_kernel;
#ifdef TOUCHSTONE_X86_64
extern const CertifiedKernel avx2_certified_kernel;
extern const CertifiedKernel avx512_certified_kernel;
#endif
#ifdef TOUCHSTONE_NEON
extern const CertifiedKernel neon_certified_kernel;
#endif

std::span<const CertifiedKernel* const> certified_kernels() {
  static const auto kernels = runnable_kernels<CertifiedKernel>(
      {
          &scalar_certified_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_certified_kernel,
          &avx512_certified_kernel,
#endif
#ifdef TOUCHSTONE_NEON
          &neon_certified_kernel,
#endif
      },
      "certified kernel", [](const CertifiedKernel& kernel) {
        return rounds_its_products(kernel) && rounds_its_products(*kernel.curves);
      });
  return kernels;
}

}  // namespace touchstone::fast

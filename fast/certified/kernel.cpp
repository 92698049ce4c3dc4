#include "fast/certified/kernel.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (kernel_*.cpp).
extern const CertifiedKernel scalar_certified_kernel;
#ifdef TOUCHSTONE_X86_64
extern const CertifiedKernel avx2_certified_kernel;
extern const CertifiedKernel avx512_certified_kernel;
#endif

namespace {

bool rounds_products(const CertifiedKernel& kernel) {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: 0 if the product rounds to 1.
  constexpr double epsilon = 0x1p-30;
  return kernel.product_then_sum(1.0 + epsilon, 1.0 - epsilon, -1.0) == 0.0;
}

}  // namespace

std::span<const CertifiedKernel* const> certified_kernels() {
  static const auto kernels = runnable_kernels<CertifiedKernel>(
      {
          &scalar_certified_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_certified_kernel,
          &avx512_certified_kernel,
#endif
      },
      "certified kernel", rounds_products);
  return kernels;
}

const CertifiedKernel& best_certified_kernel() { return *certified_kernels().back(); }

const CertifiedKernel* find_certified_kernel(InstructionSet instructions) {
  return find_kernel(certified_kernels(), instructions);
}

}  // namespace touchstone::fast

#include "fast/certified/kernel.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (kernel_*.cpp).
extern const CertifiedKernel scalar_certified_kernel;
#ifdef TOUCHSTONE_X86_64
extern const CertifiedKernel avx2_certified_kernel;
extern const CertifiedKernel avx512_certified_kernel;
#endif

namespace {

/// Does the kernel round products before it adds them? Each kernel is compiled for its own
/// instruction set, so each could be contracted by itself.
bool rounds_products(const CertifiedKernel& kernel) {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: 0 if the product rounds to 1.
  constexpr double epsilon = 0x1p-30;
  return kernel.product_then_sum(1.0 + epsilon, 1.0 - epsilon, -1.0) == 0.0;
}

std::vector<const CertifiedKernel*> runnable_kernels() {
  std::vector<const CertifiedKernel*> kernels{&scalar_certified_kernel};
#ifdef TOUCHSTONE_X86_64
  const bool has_fma = static_cast<bool>(__builtin_cpu_supports("fma"));
  if (has_fma && static_cast<bool>(__builtin_cpu_supports("avx2"))) {
    kernels.push_back(&avx2_certified_kernel);
  }
  if (has_fma && static_cast<bool>(__builtin_cpu_supports("avx512f"))) {
    kernels.push_back(&avx512_certified_kernel);
  }
#endif
  for (const CertifiedKernel* const kernel : kernels) {
    if (!rounds_products(*kernel)) {
      throw std::runtime_error(
          "touchstone: arithmetic is not strict: products are contracted in the " +
          std::string(to_string(kernel->instructions)) +
          " certified kernel (compile with -ffp-contract=off)");
    }
  }
  return kernels;
}

}  // namespace

std::span<const CertifiedKernel* const> certified_kernels() {
  static const std::vector<const CertifiedKernel*> kernels = runnable_kernels();
  return kernels;
}

const CertifiedKernel& best_certified_kernel() { return *certified_kernels().back(); }

const CertifiedKernel* find_certified_kernel(InstructionSet instructions) {
  const auto kernels = certified_kernels();
  const auto found = std::ranges::find(kernels, instructions, &CertifiedKernel::instructions);
  return found == kernels.end() ? nullptr : *found;
}

}  // namespace touchstone::fast

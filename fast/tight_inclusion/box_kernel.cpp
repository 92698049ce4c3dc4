#include "fast/tight_inclusion/box_kernel.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (box_kernel_*.cpp).
extern const BoxKernel scalar_box_kernel;
#ifdef TOUCHSTONE_X86_64
extern const BoxKernel avx2_box_kernel;
extern const BoxKernel avx512_box_kernel;
#endif

namespace {

/// Does the kernel round products before it adds them? Each kernel is compiled for its own
/// instruction set, so each could be contracted by itself.
bool rounds_products(const BoxKernel& kernel) {
  // ea0 at t0 and ea1 at t1 are (1+ε)(1−ε) − 1 for ε = 2^-30: 0 if the product rounds to 1.
  constexpr double epsilon = 0x1p-30;
  BoxProblem problem;
  problem.kind = Kind::edge_edge;
  problem.coordinates[0] = {1.0 + epsilon,  -1.0 / epsilon, 0, 0,
                            -1.0 / epsilon, 1.0 + epsilon,  0, 0};
  const CornerValues f = kernel.corners(problem, {{epsilon, 1.0 - epsilon, 0, 1, 0, 1}}, 0);
  return f[0] == 0.0 && f[6] == 0.0;
}

std::vector<const BoxKernel*> runnable_kernels() {
  std::vector<const BoxKernel*> kernels{&scalar_box_kernel};
#ifdef TOUCHSTONE_X86_64
  const bool has_fma = static_cast<bool>(__builtin_cpu_supports("fma"));
  if (has_fma && static_cast<bool>(__builtin_cpu_supports("avx2"))) {
    kernels.push_back(&avx2_box_kernel);
  }
  if (has_fma && static_cast<bool>(__builtin_cpu_supports("avx512f"))) {
    kernels.push_back(&avx512_box_kernel);
  }
#endif
  for (const BoxKernel* const kernel : kernels) {
    if (!rounds_products(*kernel)) {
      throw std::runtime_error(
          "touchstone: arithmetic is not strict: products are contracted in the " +
          std::string(to_string(kernel->instructions)) +
          " kernel (compile with -ffp-contract=off)");
    }
  }
  return kernels;
}

}  // namespace

std::span<const BoxKernel* const> box_kernels() {
  static const std::vector<const BoxKernel*> kernels = runnable_kernels();
  return kernels;
}

const BoxKernel& best_box_kernel() { return *box_kernels().back(); }

const BoxKernel* find_box_kernel(InstructionSet instructions) {
  const auto kernels = box_kernels();
  const auto found = std::ranges::find(kernels, instructions, &BoxKernel::instructions);
  return found == kernels.end() ? nullptr : *found;
}

std::string_view to_string(InstructionSet instructions) {
  switch (instructions) {
    case InstructionSet::scalar:
      return "scalar";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      break;
  }
  return "avx512";
}

}  // namespace touchstone::fast

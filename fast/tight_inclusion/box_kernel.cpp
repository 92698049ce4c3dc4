#include "fast/tight_inclusion/box_kernel.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (box_kernel_*.cpp).
extern const BoxKernel scalar_box_kernel;
#ifdef TOUCHSTONE_X86_64
extern const BoxKernel avx2_box_kernel;
#endif

namespace {

bool rounds_products(const BoxKernel& kernel) {
  // ea0 at t0 and ea1 at t1 are (1+ε)(1−ε) − 1 for ε = 2^-30: fused it is −ε², separate never (as
  // in instruction_set.hpp).
  constexpr double epsilon = 0x1p-30;
  BoxProblem problem;
  problem.kind = ContactKind::edge_edge;
  problem.coordinates[0] = {1.0 + epsilon,  -1.0 / epsilon, 0, 0,
                            -1.0 / epsilon, 1.0 + epsilon,  0, 0};
  const CornerValues f = kernel.corners(problem, {{epsilon, 1.0 - epsilon, 0, 1, 0, 1}}, 0);
  const double fused = -epsilon * epsilon;
  return f[0] != fused && f[6] != fused;
}

}  // namespace

std::span<const BoxKernel* const> box_kernels() {
  static const auto kernels = runnable_kernels<BoxKernel>(
      {
          &scalar_box_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_box_kernel,
#endif
      },
      "kernel", rounds_products);
  return kernels;
}

}  // namespace touchstone::fast

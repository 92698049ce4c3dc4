#include "fast/distance/filter_kernel.hpp"

#include <algorithm>

#include "fast/distance/filtered_distance.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (filter_*.cpp).
#if defined(TOUCHSTONE_X86_64) || defined(TOUCHSTONE_NEON)
extern const DistanceKernel fused_distance_kernel;
#endif
#ifdef TOUCHSTONE_X86_64
extern const DistanceKernel avx2_distance_kernel;
extern const DistanceKernel avx512_distance_kernel;
#endif
#ifdef TOUCHSTONE_NEON
extern const DistanceKernel neon_distance_kernel;
#endif

namespace {

void filter_one_by_one(ContactKind kind, const Query* queries, std::size_t count, double t,
                       Distance* results) {
  for (std::size_t i = 0; i < count; ++i) {
    results[i] = filtered_distance(kind, queries[i], t, Norm::l2).value_or(open_distance);
  }
}

constexpr DistanceKernel scalar_distance_kernel{
    .instructions = InstructionSet::scalar,
    .filter = filter_one_by_one,
    .product_then_sum = [](double a, double b, double c) { return a * b + c; }};

}  // namespace

std::span<const DistanceKernel* const> distance_kernels() {
  static const auto kernels = runnable_kernels<DistanceKernel>(
      {
        &scalar_distance_kernel,
#if defined(TOUCHSTONE_X86_64) || defined(TOUCHSTONE_NEON)
            &fused_distance_kernel,
#endif
#ifdef TOUCHSTONE_X86_64
            &avx2_distance_kernel, &avx512_distance_kernel,
#endif
#ifdef TOUCHSTONE_NEON
            &neon_distance_kernel,
#endif
      },
      "distance kernel", rounds_its_products<DistanceKernel>);
  return kernels;
}

const DistanceKernel& distance_kernel_for_one() {
  // The fused kernel follows the scalar one.
  static const DistanceKernel& kernel =
      *distance_kernels()[std::min<std::size_t>(1, distance_kernels().size() - 1)];
  return kernel;
}

}  // namespace touchstone::fast

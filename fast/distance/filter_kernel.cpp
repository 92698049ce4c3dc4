#include "fast/distance/filter_kernel.hpp"

#include "fast/distance/filtered_distance.hpp"

namespace touchstone::fast {

// One definition a file, each compiled for its instruction set (filter_*.cpp).
#ifdef TOUCHSTONE_X86_64
extern const DistanceKernel avx2_distance_kernel;
extern const DistanceKernel avx512_distance_kernel;
#endif

namespace {

void filter_one_by_one(Kind kind, const Query* queries, std::size_t count, double t,
                       Distance* results) {
  for (std::size_t i = 0; i < count; ++i) {
    results[i] = filtered_distance(kind, queries[i], t, Norm::l2).value_or(open_distance);
  }
}

constexpr DistanceKernel scalar_distance_kernel{
    .instructions = InstructionSet::scalar,
    .filter = filter_one_by_one,
    .product_then_sum = [](double a, double b, double c) { return a * b + c; }};

bool rounds_its_products(const DistanceKernel& kernel) {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: 0 if the product rounds to 1.
  constexpr double epsilon = 0x1p-30;
  return kernel.product_then_sum(1.0 + epsilon, 1.0 - epsilon, -1.0) == 0.0;
}

}  // namespace

std::span<const DistanceKernel* const> distance_kernels() {
  static const auto kernels = runnable_kernels<DistanceKernel>(
      {
          &scalar_distance_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_distance_kernel,
          &avx512_distance_kernel,
#endif
      },
      "distance kernel", rounds_its_products);
  return kernels;
}

}  // namespace touchstone::fast

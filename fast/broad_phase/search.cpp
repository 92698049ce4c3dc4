#include "fast/broad_phase/search.hpp"

namespace touchstone::fast {

// One definition per file, each compiled for its instruction set (search_*.cpp).
extern const SearchKernel scalar_search_kernel;
#ifdef TOUCHSTONE_X86_64
extern const SearchKernel avx2_search_kernel;
extern const SearchKernel avx512_search_kernel;
#endif
#ifdef TOUCHSTONE_NEON
extern const SearchKernel neon_search_kernel;
#endif

std::span<const SearchKernel* const> search_kernels() {
  // It multiplies nothing.
  static const auto kernels = runnable_kernels<SearchKernel>(
      {
          &scalar_search_kernel,
#ifdef TOUCHSTONE_X86_64
          &avx2_search_kernel,
          &avx512_search_kernel,
#endif
#ifdef TOUCHSTONE_NEON
          &neon_search_kernel,
#endif
      },
      "search", [](const SearchKernel& /*kernel*/) { return true; });
  return kernels;
}

const SearchKernel& best_search_kernel() { return *search_kernels().back(); }

const SearchKernel* find_search_kernel(InstructionSet instructions) {
  return find_kernel(search_kernels(), instructions);
}

}  // namespace touchstone::fast

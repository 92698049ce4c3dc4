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

// Not inline: kernels for other processors must hold no function that another file could link.
bool PairQuestions::bodies_meet(std::int32_t /*a*/, std::int32_t /*b*/) const { return true; }
bool PairQuestions::primitives_meet(const Primitive& /*a*/, const Primitive& /*b*/) const {
  return true;
}

std::span<const SearchKernel* const> search_kernels() {
  // The search multiplies nothing.
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

}  // namespace touchstone::fast

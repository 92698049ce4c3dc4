#pragma once

/// \file
/// The kernels of the certified solver and of the search that options choose.

#include "fast/broad_phase/search.hpp"
#include "fast/certified/kernel.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast {

[[nodiscard]] inline const CertifiedKernel& certified_kernel(const Kernels& chosen) {
  return chosen.certified != nullptr ? *chosen.certified : *certified_kernels().back();
}
/// The kernel for one query at a time: the lanes of the widest kernels would be empty, and their
/// instructions are slower.
[[nodiscard]] inline const CertifiedKernel& certified_kernel_for_one(const Kernels& chosen) {
  static const CertifiedKernel* const narrow =
      find_kernel(certified_kernels(), InstructionSet::avx2);
  return chosen.certified != nullptr || narrow == nullptr ? certified_kernel(chosen) : *narrow;
}
[[nodiscard]] inline const SearchKernel& search_kernel(const Kernels& chosen) {
  return chosen.search != nullptr ? *chosen.search : *search_kernels().back();
}

}  // namespace touchstone::fast

#pragma once

/// \file
/// The kernels of the solvers: the best ones for this processor, or those that a test or a
/// benchmark chooses for its thread.

#include "fast/broad_phase/search.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"

namespace touchstone::fast {

/// The chosen kernels; nullptr: the best one, for Tight-Inclusion the best for its filter.
struct Kernels {
  const CertifiedKernel* certified = nullptr;
  const SearchKernel* search = nullptr;
  const BoxKernel* box = nullptr;
};

/// The choice of this thread. Steps and methods keep the choice of the thread that makes them.
[[nodiscard]] Kernels& chosen_kernels();

[[nodiscard]] inline const CertifiedKernel& certified_kernel(const Kernels& chosen) {
  return chosen.certified != nullptr ? *chosen.certified : *certified_kernels().back();
}
/// The kernel for one query at a time: the lanes of the widest kernels would be empty, and their
/// instructions are slower.
[[nodiscard]] inline const CertifiedKernel& certified_kernel_for_one(const Kernels& chosen) {
  static const CertifiedKernel* const narrow =
      find_kernel(certified_kernels(), InstructionSet::avx2);
  if (chosen.certified != nullptr) return *chosen.certified;
  return narrow != nullptr ? *narrow : *certified_kernels().back();
}
[[nodiscard]] inline const SearchKernel& search_kernel(const Kernels& chosen) {
  return chosen.search != nullptr ? *chosen.search : *search_kernels().back();
}

/// The choice of this thread as long as the object lives.
class UseKernels {
 public:
  explicit UseKernels(const Kernels& kernels) : before_(chosen_kernels()) {
    chosen_kernels() = kernels;
  }
  UseKernels(const UseKernels&) = delete;
  UseKernels& operator=(const UseKernels&) = delete;
  UseKernels(UseKernels&&) = delete;
  UseKernels& operator=(UseKernels&&) = delete;
  ~UseKernels() { chosen_kernels() = before_; }

 private:
  Kernels before_;
};

}  // namespace touchstone::fast

#pragma once

/// \file
/// The instruction sets of kernels, and the choice among a kernel's implementations at run
/// time.

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Inlines all calls of a kernel's function, which would pass vectors through memory. (Compilations
/// that would take minutes define it as nothing: sanitizers, emulated vectors.)
#ifndef TOUCHSTONE_INLINE_CALLS
#define TOUCHSTONE_INLINE_CALLS [[gnu::flatten]]
#endif

namespace touchstone::fast {

enum class InstructionSet : std::uint8_t {
  scalar,
  avx2,    ///< AVX2 and FMA
  avx512,  ///< AVX-512 Foundation and FMA
  neon     ///< the vectors that every AArch64 has
};

/// "scalar", "avx2", "avx512" or "neon".
[[nodiscard]] std::string_view to_string(InstructionSet instructions);

/// True if this processor supports it.
[[nodiscard]] bool is_supported(InstructionSet instructions);

/// The implementations that this processor can run, in their order. A Kernel has the member
/// `instructions`; `name` is its name in errors; `rounds_products(kernel)` is true if it rounds
/// products before it adds them. Each implementation is checked, because each is compiled for its
/// own instruction set and could be contracted.
/// \throws std::runtime_error if one was compiled so that products are contracted.
template <class Kernel, class Check>
[[nodiscard]] std::vector<const Kernel*> runnable_kernels(
    std::initializer_list<const Kernel*> implementations, std::string_view name,
    const Check& rounds_products) {
  std::vector<const Kernel*> kernels;
  for (const Kernel* const kernel : implementations) {
    if (!is_supported(kernel->instructions)) continue;
    if (!rounds_products(*kernel)) {
      throw std::runtime_error(
          "touchstone: arithmetic is not strict: products are contracted in the " +
          std::string(to_string(kernel->instructions)) + " " + std::string(name) +
          " (compile with -ffp-contract=off)");
    }
    kernels.push_back(kernel);
  }
  return kernels;
}

/// a b + c on lanes of one instruction set. `Lanes` is a type of its file, with Value and width.
template <class Lanes>
double product_then_sum(double a, double b, double c) {
  using Value = typename Lanes::Value;
  alignas(64) std::array<double, Lanes::width> result;
  (Value(a) * Value(b) + Value(c)).store(result.data());
  return result[0];
}

/// A test for runnable_kernels of a kernel with the member `product_then_sum`.
template <class Kernel>
[[nodiscard]] bool rounds_its_products(const Kernel& kernel) {
  // (1+ε)(1−ε) − 1 for ε = 2^-30: fused it is −ε², separate a multiple of 2^-53, in every mode of
  // the caller.
  constexpr double epsilon = 0x1p-30;
  return kernel.product_then_sum(1.0 + epsilon, 1.0 - epsilon, -1.0) != -0x1p-60;
}

/// The implementation for an instruction set; nullptr if it is not among the kernels.
template <class Kernel>
[[nodiscard]] const Kernel* find_kernel(std::span<const Kernel* const> kernels,
                                        InstructionSet instructions) {
  const auto found = std::ranges::find(kernels, instructions, &Kernel::instructions);
  return found == kernels.end() ? nullptr : *found;
}

}  // namespace touchstone::fast

#include "fast/platform/instruction_set.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "fast/broad_phase/search.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/distance/filter_kernel.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"
#include "tests/support/messages.hpp"

namespace touchstone::fast::instruction_set_test {
namespace {

struct Kernel {
  InstructionSet instructions;
  bool is_strict = true;
};

bool rounds_products(const Kernel& kernel) { return kernel.is_strict; }

TEST(InstructionSet, OnlySupportedKernelsAreRunnableInTheirOrder) {
  static constexpr Kernel scalar{InstructionSet::scalar}, avx2{InstructionSet::avx2},
      avx512{InstructionSet::avx512}, neon{InstructionSet::neon};
  const auto kernels =
      runnable_kernels<Kernel>({&scalar, &avx2, &avx512, &neon}, "k", rounds_products);
  ASSERT_TRUE(is_supported(InstructionSet::scalar));
  std::vector<const Kernel*> expected{&scalar};
  if (is_supported(InstructionSet::avx2)) expected.push_back(&avx2);
  if (is_supported(InstructionSet::avx512)) expected.push_back(&avx512);
  if (is_supported(InstructionSet::neon)) expected.push_back(&neon);
  EXPECT_EQ(kernels, expected);
}

TEST(InstructionSet, AContractedKernelIsRefusedByName) {
  static constexpr Kernel contracted{InstructionSet::scalar, false};
  const std::string message = tests::message_of<std::runtime_error>(
      [] { (void)runnable_kernels<Kernel>({&contracted}, "test kernel", rounds_products); });
  EXPECT_NE(message.find("scalar test kernel"), std::string::npos) << message;
}

TEST(InstructionSet, ScalarKernelsAreFirst) {
  EXPECT_EQ(certified_kernels().front()->instructions, InstructionSet::scalar);
  EXPECT_EQ(search_kernels().front()->instructions, InstructionSet::scalar);
  EXPECT_EQ(box_kernels().front()->instructions, InstructionSet::scalar);
  EXPECT_EQ(distance_kernels().front()->instructions, InstructionSet::scalar);
  EXPECT_EQ(triangle_kernels().front()->instructions, InstructionSet::scalar);
}

}  // namespace
}  // namespace touchstone::fast::instruction_set_test

/// \file
/// Checks of the arithmetic, choice of kernels, memory and threads.

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <cfenv>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "fast/broad_phase/search.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/distance/filter_kernel.hpp"
#include "fast/intersections/filter_kernel.hpp"
#include "fast/platform/arithmetic_check.hpp"
#include "fast/platform/instruction_set.hpp"
#include "fast/platform/large_array.hpp"
#include "fast/platform/threads.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"
#include "tests/support/floating_point_modes.hpp"
#include "tests/support/messages.hpp"

namespace touchstone::fast::platform_test {
namespace {

TEST(ArithmeticCheck, AcceptsThisBuild) {
  EXPECT_TRUE(check_arithmetic().is_strict());
  EXPECT_NO_THROW(require_strict_arithmetic());
}

TEST(ArithmeticCheck, FindsEveryOtherRoundingModeAndSaysSo) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    EXPECT_NO_THROW(require_strict_environment());
    std::fesetround(mode);
    const ArithmeticReport report = check_arithmetic();
    EXPECT_THROW(require_strict_environment(), std::runtime_error) << mode;
    const std::string message =
        tests::message_of<std::runtime_error>([] { require_strict_arithmetic(); });
    std::fesetround(FE_TONEAREST);
    EXPECT_FALSE(report.rounds_to_nearest) << mode;
    EXPECT_TRUE(report.gradual_underflow) << mode;
    EXPECT_EQ(message,
              "touchstone: arithmetic is not strict: the rounding mode is not to nearest;");
  }
}

TEST(ArithmeticCheck, FindsFlushToZeroAndDenormalsAreZero) {
  for (const std::uint64_t flag : {tests::flush_to_zero, tests::subnormals_are_zero}) {
    const ArithmeticReport report = [flag] {
      const tests::ChangedModes changed(flag);
      EXPECT_THROW(require_strict_environment(), std::runtime_error) << flag;
      return check_arithmetic();
    }();
    EXPECT_FALSE(report.gradual_underflow) << flag;
    EXPECT_TRUE(report.rounds_to_nearest) << flag;
    EXPECT_NO_THROW(require_strict_environment());
  }
}

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

struct alignas(64) Line {
  std::array<std::uint32_t, 16> words;
};

TEST(LargeArray, HoldsItemsOfAnySize) {
  for (const std::size_t size : {0U, 1U, 1000U, 65'535U, 65'536U, 65'537U, 200'000U}) {
    LargeArray<Line> lines(size);
    for (std::size_t i = 0; i < size; ++i) lines[i].words.fill(static_cast<std::uint32_t>(i));
    const LargeArray<Line> moved = std::move(lines);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(moved[i].words[15], i) << size;
    // Large ones begin at a large page.
    const std::uintptr_t alignment = size == 200'000 ? std::uintptr_t{1} << 21U : alignof(Line);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(moved.data()) % alignment, 0U);
  }
}

TEST(LargeArray, OfSeveralThreadsAreApart) {
  std::vector<std::thread> threads;
  for (std::uint32_t of_thread = 1; of_thread <= 4; ++of_thread) {
    threads.emplace_back([of_thread] {
      for (std::size_t i = 0; i < 200; ++i) {
        const LargeArray<Line> lines(2000 + 10 * i);
        lines[0].words.fill(of_thread);
        lines[1999].words.fill(of_thread);
        std::this_thread::yield();
        EXPECT_EQ(lines[0].words[7], of_thread);
        EXPECT_EQ(lines[1999].words[7], of_thread);
      }
    });
  }
  for (std::thread& one : threads) one.join();
}

TEST(WithThreads, AllowsNoMoreThanAskedFor) {
  const auto threads = [] { return oneapi::tbb::this_task_arena::max_concurrency(); };
  EXPECT_EQ(with_threads(1, threads), 1);
  EXPECT_EQ(with_threads(0, threads), oneapi::tbb::info::default_concurrency());
  EXPECT_LE(with_threads(1000, threads), oneapi::tbb::info::default_concurrency());
}

}  // namespace
}  // namespace touchstone::fast::platform_test

#include "fast/platform/large_array.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/process_memory.hpp"

namespace touchstone::fast {
namespace {

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

#ifndef TOUCHSTONE_SANITIZED
TEST(LargeArray, HasTheMemoryOfOneBefore) {
  for (const std::size_t size : {10'000U, 200'000U}) {
    const Line* const first = LargeArray<Line>(size).data();
    const LargeArray<Line> second(size - 100), third(size);
    EXPECT_EQ(second.data(), first) << "freed before, and large enough";
    EXPECT_NE(third.data(), first) << "in use";
  }
  const Line* const large = LargeArray<Line>(200'000).data();
  EXPECT_NE(LargeArray<Line>(80'000).data(), large) << "more than twice as large";
}

TEST(LargeArray, KeepsAtMostSoMuchMemory) {
  // Five arrays of 40 MiB, each written. (The C library gives such memory back.) One is kept.
  static constexpr std::size_t size = std::size_t{40} << 14U;
  std::vector<LargeArray<Line>> arrays;
  for (int i = 0; i < 5; ++i) {
    arrays.emplace_back(size);
    for (std::size_t k = 0; k < size; k += 64) arrays.back()[k].words[0] = 1;
  }
  const std::uint64_t before = tests::process_memory().resident;
  arrays.clear();
  EXPECT_LT(tests::process_memory().resident, before - (std::uint64_t{3 * 40} << 20U));
}

TEST(LargeArray, HasMemoryThatIsKeptForOthersBeforeThereIsNone) {
  const auto fill = [] {
    static_cast<void>(LargeArray<Line>(std::size_t{32} << 14U));
    const rlim_t limit = tests::process_memory().address_space + (std::uint64_t{16} << 20U);
    const rlimit limits{.rlim_cur = limit, .rlim_max = limit};
    ::setrlimit(RLIMIT_AS, &limits);
    const LargeArray<Line> other(std::size_t{36} << 14U);  // only without the first one
    _exit(other.data() != nullptr ? 0 : 1);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(fill(), ::testing::ExitedWithCode(0), "");
}
#endif

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

}  // namespace
}  // namespace touchstone::fast

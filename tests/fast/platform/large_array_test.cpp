#include "fast/platform/large_array.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>

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
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(moved.data()) % alignof(Line), 0U);
  }
}

TEST(LargeArray, BeginsAtALargePageIfItIsLarge) {
  const LargeArray<Line> large(200'000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % (std::uintptr_t{1} << 21U), 0U);
}

TEST(LargeArray, IsNullByDefault) { EXPECT_EQ(LargeArray<Line>().data(), nullptr); }

}  // namespace
}  // namespace touchstone::fast

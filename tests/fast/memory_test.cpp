/// \file
/// Memory of searches and arrays, by what POSIX and /proc tell of this process.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <thread>
#include <utility>
#include <vector>

#include "fast/platform/large_array.hpp"
#include "tests/support/scenes.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast::memory_test {
namespace {

using tests::Places;

/// In bytes.
struct ProcessMemory {
  std::uint64_t address_space, resident;
};

ProcessMemory process_memory() {
  ProcessMemory pages{};
  std::ifstream("/proc/self/statm") >> pages.address_space >> pages.resident;
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {.address_space = pages.address_space * page, .resident = pages.resident * page};
}

void allow_mebibytes_more(std::uint64_t count) {
  const rlim_t limit = process_memory().address_space + (count << 20U);
  const rlimit limits{.rlim_cur = limit, .rlim_max = limit};
  ::setrlimit(RLIMIT_AS, &limits);
}

/// The function ends the process with 0, which is a new one: a copy of this process would inherit
/// the locks of other tests.
template <class Function>
void expect_good_exit(const Function& function) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(function(), ::testing::ExitedWithCode(0), "");
}

struct alignas(64) Line {
  std::array<std::uint32_t, 16> words;
};

TEST(Memory, OfLargeArraysIsThatOfOnesBefore) {
  for (const std::size_t size : {10'000U, 200'000U}) {
    const Line* const first = LargeArray<Line>(size).data();
    const LargeArray<Line> second(size - 100), third(size);
    EXPECT_EQ(second.data(), first) << "freed before, and large enough";
    EXPECT_NE(third.data(), first) << "in use";
  }
  const Line* const large = LargeArray<Line>(200'000).data();
  EXPECT_NE(LargeArray<Line>(80'000).data(), large) << "more than twice as large";
}

TEST(Memory, OfLargeArraysIsKeptUpToALimit) {
  // Five arrays of 40 MiB, each written. (The C library gives such memory back.) One is kept.
  static constexpr std::size_t size = std::size_t{40} << 14U;
  std::vector<LargeArray<Line>> arrays;
  for (int i = 0; i < 5; ++i) {
    arrays.emplace_back(size);
    for (std::size_t k = 0; k < size; k += 64) arrays.back()[k].words[0] = 1;
  }
  const std::uint64_t before = process_memory().resident;
  arrays.clear();
  EXPECT_LT(process_memory().resident, before - (std::uint64_t{3 * 40} << 20U));
}

TEST(Memory, ThatIsKeptIsForOthersBeforeThereIsNone) {
  expect_good_exit([] {
    static_cast<void>(LargeArray<Line>(std::size_t{32} << 14U));
    allow_mebibytes_more(16);
    const LargeArray<Line> other(std::size_t{36} << 14U);  // only without the first one
    _exit(other.data() != nullptr ? 0 : 1);
  });
}

/// Edges beside each other along a diagonal: all boxes overlap without contact.
std::pair<Places, std::vector<Edge>> crowd(std::int32_t count) {
  Places places(2 * count, 3);
  std::vector<Edge> edges;
  for (std::int32_t i = 0; i < count; ++i) {
    const double offset = 0x1p-20 * i;
    places.row(2 * i) << offset, -offset, 0;
    places.row(2 * i + 1) << 1 + offset, 1 - offset, 1;
    edges.push_back({2 * i, 2 * i + 1});
  }
  return {places, edges};
}

TEST(Memory, HasNoRoomForCandidatesThatAreCounted) {
  // 18 million pairs of eight bytes each, and room for 64 MiB.
  expect_good_exit([] {
    const auto [places, edges] = crowd(6000);
    const Motion vertices(places, places);
    allow_mebibytes_more(64);
    try {
      static_cast<void>(edge_edge_candidates(vertices, edges, {.max_threads = 1}));
    } catch (const TooManyCandidates& error) {
      _exit(error.count() == 6000U * 5999U / 2U ? 0 : 1);
    }
    _exit(2);
  });
}

TEST(Memory, HoldsNoCandidatesOfAStep) {
  // Four and a half million pairs of eight bytes each, and room for 24 MiB.
  expect_good_exit([] {
    static constexpr std::int32_t count = 3000;
    const auto [places, edges] = crowd(count);
    allow_mebibytes_more(24);
    const Step step(places, places, {.edges = edges, .faces = {}, .points = {}},
                    {.solve = {.max_threads = 1}});
    std::uint64_t found = 0;
    step.candidates([&](const StepCandidates& some) { found += some.pairs.size(); });
    if (found != std::uint64_t{count} * (count - 1) / 2) _exit(1);
    _exit(step.is_free() ? 0 : 2);
  });
}

/// oneTBB loses memory with each arena, and with each thread of the caller's outside of one.
TEST(Memory, IsNotKeptBySearchesOfSteps) {
  const Places places = Places::Identity(3, 3);
  Step step(places, places, {.faces = {{0, 1, 2}}}, {.solve = {.max_threads = 2}});
  const auto search = [&](int count) {
    for (int i = 0; i < count; ++i) {
      step = step.with_places(Motion(places, (1.0 + i) * places), {});
      EXPECT_TRUE(step.is_free());
      std::thread([&] { EXPECT_TRUE(step.collisions().empty()); }).join();
    }
  };
  search(200);
  const std::uint64_t before = process_memory().resident;
  search(2000);
  EXPECT_LT(process_memory().resident, before + (std::uint64_t{6} << 20U));
}

}  // namespace
}  // namespace touchstone::fast::memory_test

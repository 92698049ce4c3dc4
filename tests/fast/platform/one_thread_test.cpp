// threads.hpp without oneTBB. (TOUCHSTONE_TBB is not defined for this file.)

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "fast/platform/threads.hpp"

namespace touchstone::fast::one_thread_test {
namespace {

TEST(OneThread, DoesAllWorkInOrderInTheCallersThread) {
  std::vector<std::size_t> done;
  const std::thread::id own = std::this_thread::get_id();
  with_threads(0, [&] {
    EXPECT_EQ(std::this_thread::get_id(), own);
    tbb::parallel_for(std::size_t{0}, std::size_t{3}, [&](std::size_t i) { done.push_back(i); });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(3, 6, 2), [&](const auto& range) {
      EXPECT_EQ(range.size(), 3U);
      for (std::size_t i = range.begin(); i < range.end(); ++i) done.push_back(i);
    });
    tbb::parallel_invoke([&] { done.push_back(6); }, [&] { done.push_back(7); });
  });
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(OneThread, ReducesAndKeepsWhatIsOfAThread) {
  const int sum = tbb::parallel_reduce(
      tbb::blocked_range<int>(0, 5, 1), 100,
      [](const auto& range, int value) {
        for (int i = range.begin(); i < range.end(); ++i) value += i;
        return value;
      },
      std::plus<>());
  EXPECT_EQ(sum, 110);
  tbb::enumerable_thread_specific<std::vector<int>> lists;
  lists.local().push_back(1);
  lists.local().push_back(2);
  std::size_t count = 0;
  for (const std::vector<int>& list : lists) count += list.size();
  EXPECT_EQ(count, 2U);
}

}  // namespace
}  // namespace touchstone::fast::one_thread_test

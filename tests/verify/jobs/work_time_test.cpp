#include "verify/jobs/work_time.hpp"

#include <gtest/gtest.h>

namespace touchstone::verify::jobs::work_time_test {
namespace {

TEST(WorkTime, IsOfTheWorkThatIsDone) {
  bool is_done = false;
  const WorkTime time = work_time_of([&] {
    is_done = true;
    // Waits until the clocks of both have advanced.
    const double start = base::process_seconds();
    while (base::process_seconds() == start) {
    }
  });
  EXPECT_TRUE(is_done);
  EXPECT_GT(time.wall, 0.0);
  EXPECT_GT(time.processor, 0.0);
}

TEST(WorkTime, Adds) {
  const WorkTime sum =
      WorkTime{.wall = 1.0, .processor = 2.0} + WorkTime{.wall = 0.5, .processor = 4.0};
  EXPECT_EQ(sum.wall, 1.5);
  EXPECT_EQ(sum.processor, 6.0);
}

}  // namespace
}  // namespace touchstone::verify::jobs::work_time_test

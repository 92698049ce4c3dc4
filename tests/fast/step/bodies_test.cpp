#include "fast/step/bodies.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace touchstone::fast::bodies_test {
namespace {

using Numbers = std::vector<std::int32_t>;
using GroupPairs = std::vector<std::array<std::int32_t, 2>>;

TEST(Bodies, AllMeetIfNothingIsSaid) {
  const Bodies bodies(3, {});
  EXPECT_TRUE(bodies.all_meet());
  EXPECT_TRUE(bodies.meet(Numbers{0}, Numbers{1, 2}));
  const Numbers groups{0, 1, 0};
  EXPECT_TRUE(Bodies(3, {.of_vertices = groups, .apart = {}}).all_meet());
}

TEST(Bodies, DoNotMeetInEitherOrder) {
  const Numbers groups{0, 1, 2};
  const GroupPairs apart{{2, 0}, {1, 1}};
  const Bodies bodies(3, {.of_vertices = groups, .apart = apart});
  EXPECT_FALSE(bodies.all_meet());
  EXPECT_FALSE(bodies.meet(0, 2));
  EXPECT_FALSE(bodies.meet(2, 0));
  EXPECT_FALSE(bodies.meet(1, 1));
  EXPECT_TRUE(bodies.meet(0, 0));
  EXPECT_TRUE(bodies.meet(0, 1));
  EXPECT_TRUE(bodies.meet(2, 1));
}

TEST(Bodies, PrimitivesMeetIfSomeOfTheirVerticesDo) {
  const Numbers groups{0, 1, 2};
  const GroupPairs apart{{0, 2}, {1, 1}, {2, 2}};
  const Bodies bodies(3, {.of_vertices = groups, .apart = apart});
  EXPECT_TRUE(bodies.meet(Numbers{0, 1}, Numbers{2}));
  EXPECT_FALSE(bodies.meet(Numbers{0}, Numbers{2, 2}));
  EXPECT_FALSE(bodies.meet(Numbers{1}, Numbers{1, 1}));
  EXPECT_TRUE(bodies.meet(Numbers{2}, Numbers{2, 1}));
}

TEST(Bodies, AreAllInOneGroupIfNoneAreGiven) {
  const GroupPairs apart{{0, 0}};
  const Bodies bodies(2, {.of_vertices = {}, .apart = apart});
  EXPECT_FALSE(bodies.meet(Numbers{0}, Numbers{1}));
}

TEST(Bodies, RefuseGroupsThatMakeNoSense) {
  const Numbers negative{0, -1}, few{0};
  EXPECT_THROW(Bodies(2, {.of_vertices = negative, .apart = {}}), std::invalid_argument);
  EXPECT_THROW(Bodies(2, {.of_vertices = few, .apart = {}}), std::invalid_argument);
  const GroupPairs below{{0, -1}};
  EXPECT_THROW(Bodies(2, {.of_vertices = {}, .apart = below}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::fast::bodies_test

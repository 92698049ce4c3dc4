#include "fast/step/sieve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"

namespace touchstone::fast::sieve_test {
namespace {

using tests::Random;

tests::Pairs possible(const Step& step, double t_limit) {
  tests::Pairs result;
  std::mutex mutex;
  for_each_possible_collision(scene_of(step), t_limit, [&](PairKind kind, const IndexPair& pair) {
    const std::scoped_lock lock(mutex);
    result.emplace_back(kind, pair);
  });
  return result;
}

TEST(Sieve, LeavesOutNoneThatCollidesAndMostThatDoNot) {
  Random random(2400);
  std::size_t colliding = 0, others = 0, all_pairs = 0;
  for (int round = 0; round < tests::trials(60); ++round) {
    for (const tests::Shape& shape : tests::shapes()) {
      tests::Scene scene = tests::random_scene(random, shape, random.between(2, 12));
      if (round % 4 == 3)
        tests::add_thickness(scene, std::min(0.5 * shape.separation, 1e300), random);
      const Separation separation{.distance = random.coin() ? 0.0 : shape.separation,
                                  .norm = random.coin() ? Norm::l2 : Norm::linf};
      const double t_limit = random.coin() ? 1.0 : random.uniform(0.0, 0.02);
      // The time of the options has no effect.
      const tests::Pairs found =
          possible(scene.step({.separation = separation, .t_max = 0.5}), t_limit);
      const tests::AllPairs all(scene);
      for (const tests::NumberedPair& named : all.pairs()) {
        const Separation of_pair{separation.distance + all.thickness(named), separation.norm};
        const auto result = solve(Step::kind_of(named.first), all.query(named),
                                  {.t_max = t_limit, .separation = of_pair});
        const auto count = std::ranges::count(found, named);
        EXPECT_LE(count, 1);
        ++all_pairs;
        if (result.verdict == Verdict::yes) {
          ++colliding;
          EXPECT_EQ(count, 1) << shape.name;
        } else {
          others += static_cast<std::size_t>(count);
        }
      }
    }
  }
  EXPECT_GT(colliding, all_pairs / 20);
  // Coordinates of all sizes, which floating point leaves undecided, are among them.
  EXPECT_LT(others, all_pairs / 5);
}

}  // namespace
}  // namespace touchstone::fast::sieve_test

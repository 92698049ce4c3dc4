#include "fast/step/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <numbers>
#include <vector>

#include "fast/step/sieve.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/step.hpp"

namespace touchstone::fast::scene_test {
namespace {

using Places = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Sheets of n × n squares one above the other.
struct Sheets {
  static constexpr std::int32_t n = 24, sheets = 3;

  Sheets() {
    for (std::int32_t sheet = 0; sheet < sheets; ++sheet) {
      for (std::int32_t i = 0; i < n; ++i) {
        for (std::int32_t k = 0; k < n; ++k) {
          const std::int32_t a = (sheet * (n + 1) + i) * (n + 1) + k, b = a + n + 1;
          faces.push_back({a, b, b + 1});
          faces.push_back({a, b + 1, a + 1});
        }
      }
    }
  }

  /// Each sheet is turned by a multiple of an angle, and waves cross it.
  [[nodiscard]] static Places places(double angle) {
    Places result(sheets * (n + 1) * (n + 1), 3);
    Eigen::Index row = 0;
    for (std::int32_t sheet = 0; sheet < sheets; ++sheet) {
      const double c = std::cos(angle * sheet), s = std::sin(angle * sheet);
      for (std::int32_t i = 0; i <= n; ++i) {
        for (std::int32_t k = 0; k <= n; ++k) {
          const double x = i - 0.5 * n, y = k - 0.5 * n;
          result.row(row++) << c * x - s * y, s * x + c * y,
              0.1 * sheet + 0.2 * std::sin(0.7 * x + angle);
        }
      }
    }
    return result;
  }

  [[nodiscard]] static MovingVertices moving(double angle) {
    return {places(angle), places(angle + 0.1)};
  }
  [[nodiscard]] MeshElements elements() const { return {.faces = faces}; }

  std::vector<Face> faces;
};

TEST(Scene, KeepsGroupsWhileTheyAreTight) {
  const Sheets sheets;
  const Scene scene(Sheets::moving(0.5), sheets.elements(), {});
  const Scene next(Sheets::moving(0.501), scene, Separation{});
  EXPECT_TRUE(next.has_groups_of(scene));
  const Scene far(Sheets::moving(0.5 + 0.5 * std::numbers::pi), next, Separation{});
  EXPECT_FALSE(far.has_groups_of(next));
  // Motion of the whole scene, and another size, change nothing.
  const Places grown = 3.0 * Sheets::places(0.5);
  const Scene larger(MovingVertices(grown, grown), scene, Separation{});
  EXPECT_TRUE(larger.has_groups_of(scene));
}

TEST(Scene, MakesNewGroupsOfPointsThatMix) {
  std::vector<std::int32_t> points(512);
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = static_cast<std::int32_t>(i);
    order[i] = static_cast<std::int32_t>(i * 37 % points.size());
  }
  const auto on_a_line = [&](const std::vector<std::int32_t>& numbers) {
    Places places = Places::Zero(static_cast<Eigen::Index>(numbers.size()), 3);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      places(static_cast<Eigen::Index>(i), 0) = 1.0 + numbers[i];
    }
    return MovingVertices(places, places);
  };
  const Scene scene(on_a_line(points), {.points = points}, {});
  EXPECT_TRUE(Scene(on_a_line(points), scene, Separation{}).has_groups_of(scene));
  EXPECT_FALSE(Scene(on_a_line(order), scene, Separation{}).has_groups_of(scene));
}

/// The collisions in the order of their numbers.
std::vector<StepCollision> sorted(std::vector<StepCollision> collisions) {
  std::ranges::sort(collisions, {},
                    [](const StepCollision& one) { return std::tuple(one.kind, one.pair); });
  return collisions;
}

TEST(Scene, AnySequenceGivesTheAnswersOfFreshSteps) {
  const Sheets sheets;
  Step step(Sheets::moving(0.0), sheets.elements());
  std::size_t collisions = 0;
  for (const double angle : {0.05, 0.3, 0.9, 0.91, 0.92, 1.8, 0.0, 3.0}) {
    step = step.with_places(Sheets::moving(angle), {});
    const Step fresh(Sheets::moving(angle), sheets.elements());
    const std::vector<StepCollision> expected = sorted(fresh.collisions());
    collisions += expected.size();
    EXPECT_EQ(sorted(step.collisions()), expected);
    EXPECT_EQ(step.earliest(), fresh.earliest());
    EXPECT_EQ(step.is_free(), fresh.is_free());
  }
  EXPECT_GT(collisions, 1000U);
}

// ---- The sieve of its pairs ---------------------------------------------------------------------

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
  tests::Random random(2400);
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
}  // namespace touchstone::fast::scene_test

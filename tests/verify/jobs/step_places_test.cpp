#include "verify/jobs/step_places.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "exact/checker/places.hpp"
#include "tests/support/random.hpp"

// The writer's integers equal those of the checker, though the two share no code.

namespace touchstone::verify::jobs::step_places_test {
namespace {

TEST(StepPlaces, AgreeWithTheCheckers) {
  tests::Random random(1);
  int found = 0, needed = 0;
  for (int trial = 0; trial < 3'000; ++trial) {
    const double size = std::ldexp(1.0, random.between(-1070, 1020));
    Eigen::MatrixX3d start(6, 3), end(6, 3);
    std::vector<checker::Motion> motions(6);
    const double drift = random.uniform(0, 3);
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double shift = i < 3 && random.coin() ? drift * size : 0.0;
        start(i, k) = random.uniform(-size, size) + shift;
        end(i, k) = random.uniform(-size, size) + shift;
        checker::Motion& motion = motions[static_cast<std::size_t>(i)];
        motion.start.at(static_cast<std::size_t>(k)) = start(i, k);
        motion.end.at(static_cast<std::size_t>(k)) = end(i, k);
      }
    }
    const fast::MovingVertices vertices(start, end);
    const double distance = random.coin() ? 0.0 : 0.1 * size;
    const exact::Rational until = random.coin() ? 1.0 : random.uniform(0, 1);
    const StepPlaces places(vertices, distance, until);
    const checker::Places checkers(motions, distance, until);
    // (The greatest distance, or that of another pair.)
    const double less = random.coin() ? distance : distance * random.uniform(0, 1);
    const std::int64_t whole = checkers.enlarged(less);
    const bool is_vertex_face = random.coin();
    const std::array<std::int32_t, 3> a{0, 1, 0}, b{3, 4, 5}, v{2, 2, 2};
    const auto first =
        is_vertex_face ? StepPlaces::Vertices(v).first(1) : StepPlaces::Vertices(a).first(2);
    const auto second = is_vertex_face ? StepPlaces::Vertices(b) : StepPlaces::Vertices(b).first(2);
    const checker::Primitive some{0, is_vertex_face ? v : a};
    const checker::Primitive other{0, is_vertex_face ? b : std::array{3, 4, 3}};
    for (int n = 0; n < 4; ++n) {
      const StepPlaces::Direction d{random.between(-3, 3), random.between(-3, 3),
                                    random.between(-3, 3)};
      EXPECT_EQ(places.is_above(first, second, d, less), checkers.is_above(some, other, d, whole));
    }
    const bool is_apart = checkers.is_axis_between(some, other, whole);
    EXPECT_EQ(places.is_axis_between(first, second, less), is_apart);
    const auto direction = places.direction(first, second, less);
    EXPECT_TRUE(!direction || checkers.is_above(some, other, *direction, whole));
    found += direction && !is_apart ? 1 : 0;
    needed += is_apart ? 0 : 1;
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(needed, found);
}

// Two triangles near each other, in planes of any position, have a separating direction of small
// integers.
TEST(StepPlaces, FindADirectionBetweenWhatIsNear) {
  tests::Random random(2);
  int found = 0;
  for (int trial = 0; trial < 1'000; ++trial) {
    Eigen::MatrixX3d start(4, 3);
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) start(i, k) = random.uniform(-1, 1);
    }
    const Eigen::RowVector3d normal =
        (start.row(2) - start.row(1)).cross(start.row(3) - start.row(1));
    start.row(0) = (start.row(1) + start.row(2) + start.row(3)) / 3 + 0.02 * normal.normalized();
    const StepPlaces places(fast::MovingVertices(start, start), 0.0, 1);
    const std::array<std::int32_t, 4> all{0, 1, 2, 3};
    const StepPlaces::Vertices vertices(all);
    found += places.direction(vertices.first(1), vertices.last(3), 0.0) ? 1 : 0;
  }
  EXPECT_GT(found, 950);
}

}  // namespace
}  // namespace touchstone::verify::jobs::step_places_test

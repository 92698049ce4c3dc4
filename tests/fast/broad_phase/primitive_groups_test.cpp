#include "fast/broad_phase/primitive_groups.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::fast::primitive_groups_test {
namespace {

using tests::Random;

std::vector<std::int32_t> shuffled(int count, Random& random) {
  std::vector<std::int32_t> result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), 0);
  for (std::size_t i = result.size(); i > 1; --i)
    std::swap(result[i - 1], result[random.bits() % i]);
  return result;
}

FloatBounds bounds_of(const Eigen::MatrixX3d& points) {
  return FloatBounds(MovingVertices(points, points));
}

/// Expects each vertex in one place, and repeated in the lanes after the last.
void expect_all_members(const Eigen::MatrixX3d& points, const std::vector<std::int32_t>& vertices) {
  const PrimitiveGroups groups(bounds_of(points), std::span<const std::int32_t>(vertices));
  ASSERT_EQ(groups.size(), vertices.size());
  ASSERT_EQ(groups.members().size(), (vertices.size() + group_size - 1) / group_size);
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < groups.members().size() * group_size; ++i) {
    const GroupMembers& group = groups.members()[i / group_size];
    const std::size_t lane = i % group_size;
    const std::int32_t number = group.numbers[lane];
    if (i >= vertices.size()) {
      EXPECT_EQ(number, numbers.back());
      continue;
    }
    numbers.push_back(number);
    EXPECT_EQ(
        (Primitive{group.vertices[0][lane], group.vertices[1][lane], group.vertices[2][lane]}),
        primitive_of(number));
  }
  std::ranges::sort(numbers);
  EXPECT_EQ(numbers, vertices);
}

TEST(PrimitiveGroups, AreSixteenNeighboursEach) {
  // Points on a line, in any order: a group is sixteen in a row, and groups are in order. The same
  // holds for points whose distances grow without limit: only the rank counts.
  for (const int count : {16, 100, 256, 300, 5000}) {
    for (const bool is_exponential : {false, true}) {
      Random random(7);
      const std::vector<std::int32_t> place = shuffled(count, random);
      Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero(count, 3);
      for (int i = 0; i < count; ++i) {
        points(place[static_cast<std::size_t>(i)], 1) =
            is_exponential ? std::ldexp(1.0, i % 60) * (i / 60 + 1) : i;
      }
      const PrimitiveGroups groups(bounds_of(points), std::span<const std::int32_t>(place));
      double last = 0;
      for (const GroupMembers& group : groups.members()) {
        double first = 1e300, end = 0;
        for (const std::int32_t vertex : group.numbers) {
          first = std::min(first, points(vertex, 1));
          end = std::max(end, points(vertex, 1));
        }
        EXPECT_GE(first, last);
        last = end;
      }
    }
  }
}

TEST(PrimitiveGroups, OfEqualPrimitivesAreAnyAndTakeNoLongerToFind) {
  static constexpr int count = 100'001;
  const Eigen::MatrixX3d points = Eigen::MatrixX3d::Constant(count, 3, 1.0);
  std::vector<std::int32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), 0);
  expect_all_members(points, vertices);
  // Points that are almost all equal, sorted either way.
  for (const double step : {1.0, -1.0}) {
    Eigen::MatrixX3d others = points;
    for (int i = 0; i < count; ++i) others(i, i % 3) += step * (i / 30'000);
    expect_all_members(others, vertices);
  }
}

TEST(PrimitiveGroups, DoNotDependOnTheThreads) {
  Random random(6);
  Eigen::MatrixX3d points(30'000, 3);
  for (double& x : points.reshaped()) x = random.between(0, 9);
  const FloatBounds bounds = bounds_of(points);
  std::vector<Edge> edges;
  for (int i = 0; i + 1 < points.rows(); ++i) edges.push_back({i, i + 1});
  const PrimitiveGroups groups(bounds, std::span<const Edge>(edges));
  oneapi::tbb::task_arena alone(1);
  const PrimitiveGroups others =
      alone.execute([&] { return PrimitiveGroups(bounds, std::span<const Edge>(edges)); });
  for (std::size_t i = 0; i < groups.members().size(); ++i) {
    ASSERT_EQ(groups.members()[i].numbers, others.members()[i].numbers);
  }
}

}  // namespace
}  // namespace touchstone::fast::primitive_groups_test

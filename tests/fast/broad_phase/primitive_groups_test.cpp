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

/// Expects each primitive in one place, with its vertices, and repeated in the lanes after the
/// last.
template <class Element>
void expect_all_members(const PrimitiveGroups& groups, std::span<const Element> elements) {
  ASSERT_EQ(groups.size(), elements.size());
  ASSERT_EQ(groups.members().size(), (elements.size() + group_size - 1) / group_size);
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < groups.members().size() * group_size; ++i) {
    const GroupMembers& group = groups.members()[i / group_size];
    const std::size_t lane = i % group_size;
    const std::int32_t number = group.numbers[lane];
    if (i >= elements.size()) {
      EXPECT_EQ(number, numbers.back());
      continue;
    }
    numbers.push_back(number);
    const Primitive primitive{group.vertices[0][lane], group.vertices[1][lane],
                              group.vertices[2][lane]};
    if constexpr (std::is_integral_v<Element>) {
      EXPECT_EQ(primitive, primitive_of(number));
    } else {
      EXPECT_EQ(primitive, primitive_of(elements[static_cast<std::size_t>(number)]));
    }
  }
  std::vector<std::int32_t> expected(elements.size());
  if constexpr (std::is_integral_v<Element>) {
    expected.assign(elements.begin(), elements.end());
  } else {
    std::iota(expected.begin(), expected.end(), 0);
  }
  std::ranges::sort(numbers);
  std::ranges::sort(expected);
  EXPECT_EQ(numbers, expected);
}

TEST(PrimitiveGroups, HoldEveryPrimitiveOnce) {
  for (const int count : {0, 1, 7, 15, 16, 17, 255, 256, 257, 4095, 4097, 20'000}) {
    Random random(static_cast<std::uint64_t>(count));
    const auto rows = std::max(count, 1);
    Eigen::MatrixX3d points(rows, 3);
    for (double& x : points.reshaped()) x = random.uniform(-1, 1);
    std::vector<Edge> edges;
    std::vector<Face> faces;
    for (int i = 0; i < count; ++i) {
      const auto vertex = [&] { return random.between(0, rows - 1); };
      edges.push_back({vertex(), vertex()});
      faces.push_back({vertex(), vertex(), vertex()});
    }
    const std::vector<std::int32_t> vertices = shuffled(count, random);
    const FloatBounds bounds = bounds_of(points);
    expect_all_members<Edge>(PrimitiveGroups(bounds, std::span<const Edge>(edges)), edges);
    expect_all_members<Face>(PrimitiveGroups(bounds, std::span<const Face>(faces)), faces);
    expect_all_members<std::int32_t>(
        PrimitiveGroups(bounds, std::span<const std::int32_t>(vertices)), vertices);
  }
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
  static constexpr int count = 100'000;
  const Eigen::MatrixX3d points = Eigen::MatrixX3d::Constant(count, 3, 1.0);
  std::vector<std::int32_t> vertices(count);
  std::iota(vertices.begin(), vertices.end(), 0);
  expect_all_members<std::int32_t>(
      PrimitiveGroups(bounds_of(points), std::span<const std::int32_t>(vertices)), vertices);
  // Points that are almost all equal, sorted either way.
  for (const double step : {1.0, -1.0}) {
    Eigen::MatrixX3d others = points;
    for (int i = 0; i < count; ++i) others(i, i % 3) += step * (i / 30'000);
    expect_all_members<std::int32_t>(
        PrimitiveGroups(bounds_of(others), std::span<const std::int32_t>(vertices)), vertices);
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

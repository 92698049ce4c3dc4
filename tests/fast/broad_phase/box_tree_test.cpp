#include "fast/broad_phase/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "tests/support/random.hpp"

namespace touchstone::fast::box_tree_test {
namespace {

using tests::Random;

/// Faces at random places.
struct Cloud {
  explicit Cloud(int count) : vertices(places(count, 1), places(count, 2)), bounds(vertices) {
    Random random(3);
    for (int i = 0; i < count; ++i) {
      faces.push_back({i, random.between(0, count - 1), random.between(0, count - 1)});
    }
  }

  static Eigen::MatrixX3d places(int count, std::uint64_t seed) {
    Random random(seed);
    Eigen::MatrixX3d result(std::max(count, 1), 3);
    for (double& x : result.reshaped()) x = random.uniform(-1, 1);
    return result;
  }

  MovingVertices vertices;
  FloatBounds bounds;
  std::vector<Face> faces;
};

/// The box of a face, from its vertices.
template <std::size_t instants>
LaneBox<instants> box_of(const Cloud& cloud, const Face& face) {
  LaneBox<instants> box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<float, 2> lower{9, 9}, upper{-9, -9};
    for (const std::int32_t index : face) {
      const VertexBounds& vertex = cloud.bounds[static_cast<std::size_t>(index)];
      for (std::size_t end = 0; end < 2; ++end) {
        lower[end] = std::min(lower[end], vertex.lower[end][axis]);
        upper[end] = std::max(upper[end], vertex.upper[end][axis]);
      }
    }
    if constexpr (instants == 2) {
      for (std::size_t end = 0; end < 2; ++end) {
        box.lower[end][axis] = lower[end];
        box.upper[end][axis] = upper[end];
      }
    } else {
      box.lower[0][axis] = std::min(lower[0], lower[1]);
      box.upper[0][axis] = std::max(upper[0], upper[1]);
    }
  }
  return box;
}

template <std::size_t instants>
void expect_boxes(const Cloud& cloud) {
  const PrimitiveGroups groups(cloud.bounds, std::span<const Face>(cloud.faces));
  BoxTree<instants> tree(groups);
  tree.fit(cloud.bounds);
  if (cloud.faces.empty()) {
    EXPECT_TRUE(tree.levels().empty());
    return;
  }
  ASSERT_GE(tree.levels().size(), 2U);
  EXPECT_EQ(tree.levels().back().size(), 1U);
  ASSERT_EQ(tree.levels()[0].boxes, cloud.faces.size());
  for (std::size_t i = 0; i < cloud.faces.size(); ++i) {
    const auto number =
        static_cast<std::size_t>(tree.members()[i / group_size].numbers[i % group_size]);
    const LaneBox<instants> box = tree.levels()[0].groups[i / group_size].box(i % group_size);
    const LaneBox<instants> expected = box_of<instants>(cloud, cloud.faces[number]);
    EXPECT_EQ(box.lower, expected.lower);
    EXPECT_EQ(box.upper, expected.upper);
  }
  for (std::size_t level = 1; level < tree.levels().size(); ++level) {
    const BoxLevel<instants>&here = tree.levels()[level], &below = tree.levels()[level - 1];
    ASSERT_EQ(here.boxes, below.size());
    for (std::size_t i = 0; i < here.boxes; ++i) {
      LaneBox<instants> around = below.groups[i].box(0);
      for (std::size_t lane = 1; lane < group_size; ++lane) {
        if ((below.lanes(i) >> lane & 1U) == 0) continue;
        const LaneBox<instants> box = below.groups[i].box(lane);
        for (std::size_t end = 0; end < instants; ++end) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            around.lower[end][axis] = std::min(around.lower[end][axis], box.lower[end][axis]);
            around.upper[end][axis] = std::max(around.upper[end][axis], box.upper[end][axis]);
          }
        }
      }
      const LaneBox<instants> box = here.groups[i / group_size].box(i % group_size);
      EXPECT_EQ(box.lower, around.lower);
      EXPECT_EQ(box.upper, around.upper);
    }
  }
}

TEST(BoxTree, HasBoxesAroundPrimitivesAndAroundBoxes) {
  for (const int count : {0, 1, 2, 15, 16, 17, 255, 256, 257, 4000, 4097}) {
    const Cloud cloud(count);
    expect_boxes<1>(cloud);
    expect_boxes<2>(cloud);
  }
}

TEST(BoxTree, IsFittedAnew) {
  const Cloud cloud(1000);
  const PrimitiveGroups groups(cloud.bounds, std::span<const Face>(cloud.faces));
  BoxTree<2> tree(groups);
  const Eigen::MatrixX3d nowhere = Eigen::MatrixX3d::Zero(1000, 3);
  tree.fit(FloatBounds(MovingVertices(nowhere, nowhere)));
  EXPECT_EQ(tree.levels().back().groups[0].box(0).upper[1][2], 0.0F);
  tree.fit(cloud.bounds);
  EXPECT_GT(tree.levels().back().groups[0].box(0).upper[1][2], 0.9F);
}

TEST(BoxLevel, NamesTheLanesThatAreBoxes) {
  const BoxLevel<1> level{.groups = nullptr, .boxes = 35};
  EXPECT_EQ(level.size(), 3U);
  EXPECT_EQ(level.lanes(0), 0xFFFFU);
  EXPECT_EQ(level.lanes(1), 0xFFFFU);
  EXPECT_EQ(level.lanes(2), 0b111U);
}

}  // namespace
}  // namespace touchstone::fast::box_tree_test
